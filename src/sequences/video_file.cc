// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/video_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <system_error>
#include <utility>

#include "hullslam/util/error.h"
#include "images/ffmpeg.h"
#include "images/image_file.h"
#include "sequences/image_list.h"

extern "C" {
#include <libavutil/display.h>
}

namespace hullslam {
namespace {

// The demuxers, by FFmpeg's names.
constexpr const char* kContainers =
    "mov,matroska,avi,mpeg,mpegts,mpegvideo,m4v,h264,hevc,asf,flv,ogg,mjpeg,ivf,yuv4mpegpipe,gif";

// How a stored image becomes the shown one: x and y are swapped first, then the axes are reversed.
struct Turn {
  bool is_transposed = false;
  bool is_x_reversed = false;
  bool is_y_reversed = false;
};

// A stored pixel (x, y) is shown at (a x + c y, b x + d y); the matrix has a and b, then c and d at
// its fourth number, as 16.16 numbers (ISO 14496-12, 8.3.2). Cameras only write turns by right
// angles and reflections; for any other matrix the nearest turn is taken.
Turn TurnOf(const AVStream& stream) {
  size_t size = 0;
  const uint8_t* const data =
      LoadFfmpeg().av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, &size);
  if (data == nullptr || size < 9 * sizeof(int32_t)) {
    return {};
  }
  const auto* const matrix = reinterpret_cast<const int32_t*>(data);
  const bool is_transposed = std::abs(int64_t{matrix[1]}) > std::abs(int64_t{matrix[0]});
  return {.is_transposed = is_transposed,
          .is_x_reversed = matrix[is_transposed ? 3 : 0] < 0,
          .is_y_reversed = matrix[is_transposed ? 1 : 4] < 0};
}

// A copy of the image that is turned.
cv::Mat Turned(const cv::Mat& image, const Turn& turn) {
  cv::Mat turned = turn.is_transposed ? cv::Mat(image.t()) : image.clone();
  if (turn.is_x_reversed) {
    cv::flip(turned, turned, 1);
  }
  if (turn.is_y_reversed) {
    cv::flip(turned, turned, 0);
  }
  return turned;
}

struct Free {
  void operator()(AVFormatContext* file) const { LoadFfmpeg().avformat_close_input(&file); }
  void operator()(AVCodecContext* codec) const { LoadFfmpeg().avcodec_free_context(&codec); }
  void operator()(AVPacket* packet) const { LoadFfmpeg().av_packet_free(&packet); }
  void operator()(AVFrame* frame) const { LoadFfmpeg().av_frame_free(&frame); }
  void operator()(AVDictionary* options) const { LoadFfmpeg().av_dict_free(&options); }
  void operator()(SwsContext* converter) const { LoadFfmpeg().sws_freeContext(converter); }
};
template <typename Resource>
using Owned = std::unique_ptr<Resource, Free>;

}  // namespace

// Decodes the frames of a file once, in the order in which they are shown.
class VideoFile::Decoder {
 public:
  // Not usable if it cannot be opened.
  explicit Decoder(const std::filesystem::path& path) {
    LoadFfmpeg().av_log_set_level(
        AV_LOG_FATAL);  // what is wrong with a file is told by errors, not on stderr
    AVDictionary* options = nullptr;
    LoadFfmpeg().av_dict_set(&options, "format_whitelist", kContainers, 0);
    LoadFfmpeg().av_dict_set(&options, "protocol_whitelist", "file", 0);
    AVFormatContext* file = nullptr;
    // Without its protocol, a name with a colon would be taken for an address.
    const int code = LoadFfmpeg().avformat_open_input(&file, ("file:" + path.string()).c_str(),
                                                      nullptr, &options);
    const Owned<AVDictionary> unused(options);
    file_.reset(file);
    if (code < 0 || LoadFfmpeg().avformat_find_stream_info(file, nullptr) < 0) {
      return;
    }
    const AVCodec* coding = nullptr;
    stream_ = LoadFfmpeg().av_find_best_stream(file, AVMEDIA_TYPE_VIDEO, -1, -1, &coding, 0);
    if (stream_ >= 0 && coding != nullptr) {
      OpenCodec(*coding);
    }
  }

  bool is_open() const { return is_open_; }
  // The size of the stored images; 0 if there are none.
  int width() const { return stream_ >= 0 ? Stream().codecpar->width : 0; }
  int height() const { return stream_ >= 0 ? Stream().codecpar->height : 0; }
  Turn turn() const { return TurnOf(Stream()); }

  // Goes to the next frame; false after the last one. Packets that cannot be decoded are skipped.
  bool Next() {
    for (int code = 0; code != AVERROR_EOF;) {
      code = LoadFfmpeg().avcodec_receive_frame(codec_.get(), frame_.get());
      if (code == 0) {
        return true;
      }
      if (is_drained_ && code != AVERROR_EOF) {
        return false;
      }
      SendPacket();
    }
    return false;
  }

  double Seconds() const {
    const int64_t stamp = frame_->best_effort_timestamp;
    if (stamp == AV_NOPTS_VALUE) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    const int64_t begin = Stream().start_time == AV_NOPTS_VALUE ? 0 : Stream().start_time;
    return static_cast<double>(stamp - begin) * av_q2d(Stream().time_base);
  }

  bool HasOwnStamp() const { return frame_->pts != AV_NOPTS_VALUE; }

  // The time between two frames, s. AVI stores a constant one instead of stamps, so the decoder
  // has none for the frames that come after the end of the file. Not a number if it is not known.
  double Interval() const {
    const AVRational rate = Stream().avg_frame_rate;
    return rate.num > 0 && rate.den > 0 ? 1.0 / av_q2d(rate)
                                        : std::numeric_limits<double>::quiet_NaN();
  }

  // The current frame, CV_8UC3 with blue first; empty if it cannot be converted.
  cv::Mat Image() {
    const int width = frame_->width;
    const int height = frame_->height;
    const auto format = static_cast<AVPixelFormat>(frame_->format);
    converter_.reset(LoadFfmpeg().sws_getCachedContext(converter_.release(), width, height, format,
                                                       width, height, AV_PIX_FMT_BGR24, SWS_BICUBIC,
                                                       nullptr, nullptr, nullptr));
    const Owned<AVFrame> bgr(LoadFfmpeg().av_frame_alloc());
    bgr->width = width;
    bgr->height = height;
    bgr->format = AV_PIX_FMT_BGR24;
    if (converter_ == nullptr || LoadFfmpeg().av_frame_get_buffer(bgr.get(), 0) < 0 ||
        LoadFfmpeg().sws_scale(converter_.get(), frame_->data, frame_->linesize, 0, height,
                               bgr->data, bgr->linesize) != height) {
      return {};
    }
    const cv::Mat stored(height, width, CV_8UC3, bgr->data[0],
                         static_cast<size_t>(bgr->linesize[0]));
    return Turned(stored, turn());
  }

 private:
  const AVStream& Stream() const { return *file_->streams[stream_]; }

  void OpenCodec(const AVCodec& coding) {
    codec_.reset(LoadFfmpeg().avcodec_alloc_context3(&coding));
    if (codec_ == nullptr ||
        LoadFfmpeg().avcodec_parameters_to_context(codec_.get(), Stream().codecpar) < 0) {
      return;
    }
    codec_->pkt_timebase = Stream().time_base;
    codec_->thread_count = 0;  // one per core
    codec_->max_pixels = kMostImagePixels;
    is_open_ = LoadFfmpeg().avcodec_open2(codec_.get(), &coding, nullptr) >= 0;
  }

  // Gives the decoder the next packet of the stream, or tells it that there are no more.
  void SendPacket() {
    while (LoadFfmpeg().av_read_frame(file_.get(), packet_.get()) >= 0) {
      const bool is_of_stream = packet_->stream_index == stream_;
      if (is_of_stream) {
        LoadFfmpeg().avcodec_send_packet(codec_.get(), packet_.get());
      }
      LoadFfmpeg().av_packet_unref(packet_.get());
      if (is_of_stream) {
        return;
      }
    }
    LoadFfmpeg().avcodec_send_packet(codec_.get(), nullptr);
    is_drained_ = true;
  }

  Owned<AVFormatContext> file_;
  Owned<AVCodecContext> codec_;
  Owned<AVPacket> packet_{LoadFfmpeg().av_packet_alloc()};
  Owned<AVFrame> frame_{LoadFfmpeg().av_frame_alloc()};
  Owned<SwsContext> converter_;
  int stream_ = -1;
  bool is_open_ = false;
  bool is_drained_ = false;
};

VideoFile::VideoFile(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path_, error)) {
    throw InputError(path_.string() + ": is not a file, expected a video");
  }
  Rewind();
}

VideoFile::~VideoFile() = default;

void VideoFile::Rewind() {
  decoder_ = std::make_unique<Decoder>(path_);
  const auto pixels = int64_t{decoder_->width()} * decoder_->height();
  if (pixels > static_cast<int64_t>(kMostImagePixels)) {
    throw InputError(fmt::format("{}: has images of {}x{} px, expected up to {} million px",
                                 path_.string(), decoder_->width(), decoder_->height(),
                                 kMostImagePixels / 1'000'000));
  }
  if (!decoder_->is_open()) {
    throw InputError(path_.string() +
                     ": cannot be decoded, expected a video that FFmpeg can read, or a folder of "
                     "images");
  }
  next_ = 0;
}

std::vector<double> VideoFile::ReadStamps() {
  Rewind();
  std::vector<double> stamps;
  double begin = 0.0;  // s; without stamps, the first frame has the time at which it was decoded
  while (decoder_->Next()) {
    if (stamps.empty() && !decoder_->HasOwnStamp()) {
      begin = decoder_->Seconds();
    }
    double stamp = decoder_->Seconds() - begin;
    if (std::isnan(stamp) && !stamps.empty()) {
      stamp = stamps.back() + decoder_->Interval();
    }
    stamps.push_back(stamp);
    if (stamps.size() > kMostImages) {
      throw InputError(fmt::format("{}: more than {} frames", path_.string(), kMostImages));
    }
  }
  if (stamps.empty()) {
    throw InputError(path_.string() + ": no frame of the video can be decoded");
  }
  Rewind();
  return stamps;
}

cv::Mat VideoFile::ReadColour(size_t number) {
  if (number < next_) {
    Rewind();
  }
  bool is_decoded = true;
  for (; is_decoded && next_ <= number; ++next_) {
    is_decoded = decoder_->Next();
  }
  cv::Mat image = is_decoded ? decoder_->Image() : cv::Mat();
  if (image.empty()) {
    throw InputError(fmt::format("{}: frame {} cannot be decoded", path_.string(), number));
  }
  return image;
}

cv::Mat VideoFile::ReadGrey(size_t number) {
  cv::Mat grey;
  cv::cvtColor(ReadColour(number), grey, cv::COLOR_BGR2GRAY);
  return grey;
}

std::string VideoFile::DescribeTurn() const {
  const Turn turn = decoder_->turn();
  if (turn.is_transposed != (turn.is_x_reversed != turn.is_y_reversed)) {
    return "mirrored";
  }
  if (turn.is_transposed) {
    return fmt::format("turned by 90 degrees {}clockwise", turn.is_x_reversed ? "" : "counter");
  }
  return turn.is_x_reversed ? "turned by 180 degrees" : "";
}

}  // namespace hullslam
