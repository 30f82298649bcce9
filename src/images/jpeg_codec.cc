// SPDX-License-Identifier: GPL-3.0-or-later
#include "images/image_codecs.h"

// jpeglib.h needs size_t and FILE.
#include <cstddef>
#include <cstdio>

extern "C" {
#include <jerror.h>
#include <jpeglib.h>
}

#include <array>
#include <csetjmp>
#include <cstdlib>
#include <memory>
#include <vector>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

// libjpeg ends a call that fails by a function that must not return. As in png_codec.cc it is
// longjmp, and calls are in functions that have no variables with a destructor.
struct JpegFailure {
  jpeg_error_mgr manager = {};  // must come first: libjpeg knows only this part
  std::jmp_buf target = {};
  std::array<char, JMSG_LENGTH_MAX> text = {};
  bool is_cut_off = false;
  bool has_too_many_scans = false;
};

JpegFailure& FailureOf(j_common_ptr jpeg) { return *reinterpret_cast<JpegFailure*>(jpeg->err); }

[[noreturn]] void JumpOut(j_common_ptr jpeg) {
  JpegFailure& failure = FailureOf(jpeg);
  failure.manager.format_message(jpeg, failure.text.data());
  std::longjmp(failure.target, 1);
}

// libjpeg fills what is missing at the end with grey. Other warnings are about bytes that it has
// passed over, and it goes on.
void TakeWarning(j_common_ptr jpeg, int level) {
  if (level < 0 && FailureOf(jpeg).manager.msg_code == JWRN_JPEG_EOF) {
    FailureOf(jpeg).is_cut_off = true;
    JumpOut(jpeg);
  }
}

// Each scan of a progressive JPEG goes through all of its pixels, but a scan may be a few bytes. So
// libjpeg-turbo advises programs to limit their number. Encoders make 10, seldom twice as many.
constexpr int kMostScans = 50;

void LimitScans(j_common_ptr jpeg) {
  if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number > kMostScans) {
    FailureOf(jpeg).has_too_many_scans = true;
    JumpOut(jpeg);
  }
}

void SetFailure(JpegFailure& failure) {
  jpeg_std_error(&failure.manager);
  failure.manager.error_exit = JumpOut;
  failure.manager.emit_message = TakeWarning;
}

class JpegReader {
 public:
  JpegReader() {
    SetFailure(failure_);
    jpeg_.err = &failure_.manager;
  }
  ~JpegReader() { jpeg_destroy_decompress(&jpeg_); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  ImageHeader ReadHeader(std::string_view bytes) {
    if (setjmp(failure_.target) != 0) {
      Fail();
    }
    jpeg_create_decompress(&jpeg_);
    jpeg_.progress = &progress_;
    progress_.progress_monitor = LimitScans;
    jpeg_mem_src(&jpeg_, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&jpeg_, TRUE);
    return {.width = jpeg_.image_width,
            .height = jpeg_.image_height,
            .channels = jpeg_.num_components,
            .bits = jpeg_.data_precision};
  }

  void ReadPixels(cv::Mat& image) {
    if (setjmp(failure_.target) != 0) {
      Fail();
    }
    jpeg_.out_color_space = image.channels() == 3 ? JCS_EXT_BGR : JCS_GRAYSCALE;
    jpeg_start_decompress(&jpeg_);
    while (jpeg_.output_scanline < jpeg_.output_height) {
      JSAMPROW row = image.ptr<uint8_t>(static_cast<int>(jpeg_.output_scanline));
      jpeg_read_scanlines(&jpeg_, &row, 1);
    }
    jpeg_finish_decompress(&jpeg_);
  }

 private:
  [[noreturn]] void Fail() const {
    if (failure_.is_cut_off) {
      throw DecodeError("is cut off, the end of the image is missing");
    }
    if (failure_.has_too_many_scans) {
      throw DecodeError("has more than " + std::to_string(kMostScans) +
                        " scans, expected a JPEG of a camera, which has 1 to 20");
    }
    throw DecodeError(std::string("is broken and cannot be decoded: ") + failure_.text.data());
  }

  JpegFailure failure_;
  jpeg_progress_mgr progress_ = {};
  jpeg_decompress_struct jpeg_ = {};
};

// The bytes that jpeg_mem_dest has allocated.
struct JpegBytes {
  unsigned char* data = nullptr;
  unsigned long size = 0;

  JpegBytes() = default;
  ~JpegBytes() { std::free(data); }
  JpegBytes(const JpegBytes&) = delete;
  JpegBytes& operator=(const JpegBytes&) = delete;
};

class JpegWriter {
 public:
  JpegWriter() {
    SetFailure(failure_);
    jpeg_.err = &failure_.manager;
  }
  ~JpegWriter() { jpeg_destroy_compress(&jpeg_); }
  JpegWriter(const JpegWriter&) = delete;
  JpegWriter& operator=(const JpegWriter&) = delete;

  void Write(const cv::Mat& image, int quality, JpegBytes& bytes) {
    if (setjmp(failure_.target) != 0) {
      throw std::logic_error(failure_.text.data());
    }
    jpeg_create_compress(&jpeg_);
    jpeg_mem_dest(&jpeg_, &bytes.data, &bytes.size);
    jpeg_.image_width = static_cast<JDIMENSION>(image.cols);
    jpeg_.image_height = static_cast<JDIMENSION>(image.rows);
    jpeg_.input_components = image.channels();
    jpeg_.in_color_space = image.channels() == 3 ? JCS_EXT_BGR : JCS_GRAYSCALE;
    jpeg_set_defaults(&jpeg_);
    jpeg_set_quality(&jpeg_, quality, TRUE);
    jpeg_start_compress(&jpeg_, TRUE);
    while (jpeg_.next_scanline < jpeg_.image_height) {
      // libjpeg only reads from the row.
      JSAMPROW row =
          const_cast<uint8_t*>(image.ptr<uint8_t>(static_cast<int>(jpeg_.next_scanline)));
      jpeg_write_scanlines(&jpeg_, &row, 1);
    }
    jpeg_finish_compress(&jpeg_);
  }

 private:
  JpegFailure failure_;
  jpeg_compress_struct jpeg_ = {};
};

}  // namespace

cv::Mat DecodeJpeg(std::string_view bytes, PixelForm form, const HeaderCheck& check) {
  JpegReader reader;
  const ImageHeader header = reader.ReadHeader(bytes);
  check(header);
  if (header.channels != 1 && header.channels != 3) {
    throw DecodeError("has " + std::to_string(header.channels) +
                      " channels, expected a JPEG that is grey or in colour (not CMYK)");
  }
  Check(form != PixelForm::kSixteenBit, "a JPEG has 8 bits");
  cv::Mat image(static_cast<int>(header.height), static_cast<int>(header.width),
                form == PixelForm::kColour ? CV_8UC3 : CV_8UC1);
  reader.ReadPixels(image);
  return image;
}

std::string EncodeJpeg(const cv::Mat& image, int quality) {
  Check(
      image.depth() == CV_8U && (image.channels() == 1 || image.channels() == 3) && !image.empty(),
      "a JPEG is made of 8 bits and 1 or 3 channels");
  JpegBytes bytes;
  JpegWriter().Write(image, quality, bytes);
  return {reinterpret_cast<const char*>(bytes.data), bytes.size};
}

}  // namespace hullslam
