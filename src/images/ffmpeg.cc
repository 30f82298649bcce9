// SPDX-License-Identifier: GPL-3.0-or-later
#include "images/ffmpeg.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace hullslam {
namespace {

// A library of the version whose headers were compiled. It stays loaded until the program ends.
class LoadedLibrary {
 public:
  LoadedLibrary(const char* name, int version)
      : file_(fmt::format("lib{}.so.{}", name, version)),
        handle_(dlopen(file_.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) {
      throw std::runtime_error(
          fmt::format("FFmpeg is needed to read videos, and {} cannot be loaded", file_));
    }
  }

  template <typename Function>
  void Find(const char* name, Function& function) const {
    function = reinterpret_cast<Function>(dlsym(handle_, name));
    if (function == nullptr) {
      throw std::runtime_error(fmt::format("{} has no function {}", file_, name));
    }
  }

 private:
  std::string file_;
  void* handle_;
};

#define HULLSLAM_FIND(library, name) library.Find(#name, ffmpeg.name)

Ffmpeg FindAll() {
  Ffmpeg ffmpeg = {};
  const LoadedLibrary util("avutil", LIBAVUTIL_VERSION_MAJOR);
  HULLSLAM_FIND(util, av_log_set_level);
  HULLSLAM_FIND(util, av_dict_set);
  HULLSLAM_FIND(util, av_dict_free);
  HULLSLAM_FIND(util, av_frame_alloc);
  HULLSLAM_FIND(util, av_frame_free);
  HULLSLAM_FIND(util, av_frame_get_buffer);
  const LoadedLibrary codec("avcodec", LIBAVCODEC_VERSION_MAJOR);
  HULLSLAM_FIND(codec, avcodec_alloc_context3);
  HULLSLAM_FIND(codec, avcodec_free_context);
  HULLSLAM_FIND(codec, avcodec_open2);
  HULLSLAM_FIND(codec, avcodec_parameters_to_context);
  HULLSLAM_FIND(codec, avcodec_receive_frame);
  HULLSLAM_FIND(codec, avcodec_send_packet);
  HULLSLAM_FIND(codec, av_packet_alloc);
  HULLSLAM_FIND(codec, av_packet_free);
  HULLSLAM_FIND(codec, av_packet_unref);
  const LoadedLibrary format("avformat", LIBAVFORMAT_VERSION_MAJOR);
  HULLSLAM_FIND(format, avformat_open_input);
  HULLSLAM_FIND(format, avformat_close_input);
  HULLSLAM_FIND(format, avformat_find_stream_info);
  HULLSLAM_FIND(format, av_find_best_stream);
  HULLSLAM_FIND(format, av_read_frame);
  HULLSLAM_FIND(format, av_stream_get_side_data);
  const LoadedLibrary scale("swscale", LIBSWSCALE_VERSION_MAJOR);
  HULLSLAM_FIND(scale, sws_getCachedContext);
  HULLSLAM_FIND(scale, sws_freeContext);
  HULLSLAM_FIND(scale, sws_scale);
  return ffmpeg;
}

#undef HULLSLAM_FIND

}  // namespace

const Ffmpeg& LoadFfmpeg() {
  static const Ffmpeg ffmpeg = FindAll();
  return ffmpeg;
}

}  // namespace hullslam
