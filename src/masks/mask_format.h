// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "hullslam/masks/mask_source.h"
#include "masks/mask_probe.h"

namespace hullslam {

// A format of mask files. Each format has its own file, which defines one constant of this type.
// The table in open_masks.cc lists all formats.
struct MaskFormat {
  std::string_view name;  // the name of --masks-format
  // How the format is recognised if its name is not given: a folder by its files, a JSON file by
  // its keys. A format is a folder or a file and sets only one of the two.
  bool (*is_meant)(const MaskProbe& folder) = nullptr;
  std::span<const std::string_view> json_keys = {};  // one of them comes first in the file
  std::unique_ptr<MaskSource> (*open)(const MaskRequest& request) = nullptr;
};

// MaskFormat::open of a class that is made from the request.
template <typename Masks>
std::unique_ptr<MaskSource> OpenAs(const MaskRequest& request) {
  return std::make_unique<Masks>(request);
}

// Format coco: a JSON file with results or instances in the format of COCO (cocodataset.org), with
// polygons or run lengths, else boxes. It also reads the files that SAM and Ultralytics write.
extern const MaskFormat kCocoFormat;

// Format json: a folder with `<stem>.json` for each image, in one of three forms: a list of masks
// (Segment Anything), an object with the list "annotations" of COCO's form (SA-1B), or an object
// with the list "shapes" (LabelMe and its followers).
extern const MaskFormat kJsonFolderFormat;

// Format label-png. `<stem>.png` has the number of the instance in each pixel, 0 for none: grey
// with 8 or 16 bits, or the indices of a palette.
// classes.json has the classes of the instances: {"1": "cup", "2": {"class": "tv", "score": 0.9}}
// for all frames. {"frames": {"<stem>": {"1": "mouse"}}} is for one frame and takes precedence.
extern const MaskFormat kLabelPngFormat;

// Format oa-slam: a JSON file with a list of {"file_name", "detections": [{"category_id",
// "detection_score", "bbox": [x1, y1, x2, y2]}]}, which OA-SLAM (Zins et al. 2022) reads. A
// detection may also have an "ellipse": [cx, cy, a, b, angle], as in VOOM (Wang et al. 2024).
extern const MaskFormat kOaSlamFormat;

// Format paper: `segmentation_txt/000012.txt` for frame number 12, with one line `instance track
// label confidence x1 y1 ... xn yn` per instance, in pixels whose centres are integers. Yu et al.
// 2025 read these files. The label is a number or a name.
extern const MaskFormat kPaperFormat;

// Format yolo-seg: `<stem>.txt` with one line `class x1 y1 ... xn yn [confidence]` per instance;
// coordinates are fractions of width and height.
extern const MaskFormat kYoloSegFormat;

// Format boxes: `<stem>.txt` with one line per box, in one of two forms. The first box of the
// folder decides which.
// - `class x y width height score` in pixels; x and y are the upper left corner. EAO-SLAM reads
//   these files (Wu et al. 2020).
// - `class x y width height [confidence]` in shares of the image; x and y are the centre. YOLO
//   writes these files for detections (Ultralytics, save_txt).
// In the second form, the number of a track may be the last column (`yolo detect track`).
extern const MaskFormat kBoxesFormat;

// Whether the first line is one of the second form with both a confidence and a track. It has as
// many numbers as an outline of three points.
bool IsTrackedBox(const MaskProbe& probe);

}  // namespace hullslam
