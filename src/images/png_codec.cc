// SPDX-License-Identifier: GPL-3.0-or-later
#include <png.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <cstdio>
#include <cstring>
#include <vector>

#include "hullslam/util/check.h"
#include "images/image_codecs.h"

namespace hullslam {
namespace {

// libpng ends a call that fails by longjmp, which must not pass over an object with a destructor.
// So each call of it is in a member function that has no such variables. The message is kept here.
struct PngMessage {
  std::array<char, 128> text = {};
};

constexpr const char* kCutOff = "is cut off, the end of the image is missing";
constexpr const char* kBroken = "is broken and cannot be decoded: ";

uint32_t NumberAt(std::string_view bytes, size_t at) {
  uint32_t number = 0;
  for (const char byte : bytes.substr(at, 4)) {
    number = number << 8 | static_cast<uint8_t>(byte);
  }
  return number;
}

// Checks that all chunks are there, up to the last one, and that their sums are right. A chunk is
// its length, its name, its data, and the sum of name and data. png_read_end() is not used: it
// decompresses all that follows the pixels in their chunks, a gigabyte for each megabyte.
void CheckChunks(std::string_view bytes) {
  constexpr size_t kSignature = 8;
  constexpr size_t kFrame = 12;  // a chunk without its data
  for (size_t at = kSignature;;) {
    const size_t left = bytes.size() - at;
    if (left < kFrame || NumberAt(bytes, at) > left - kFrame) {
      throw DecodeError(kCutOff);
    }
    const size_t length = NumberAt(bytes, at);
    const std::string_view summed = bytes.substr(at + 4, 4 + length);
    const auto sum =
        crc32(0, reinterpret_cast<const Bytef*>(summed.data()), static_cast<uInt>(summed.size()));
    if (sum != NumberAt(bytes, at + 8 + length)) {
      throw DecodeError(std::string(kBroken) + "a sum of its bytes is wrong");
    }
    if (summed.starts_with("IEND")) {
      return;
    }
    at += kFrame + length;
  }
}

[[noreturn]] void KeepPngMessage(png_structp png, png_const_charp text) {
  auto& message = *static_cast<PngMessage*>(png_get_error_ptr(png));
  std::snprintf(message.text.data(), message.text.size(), "%s", text);
  png_longjmp(png, 1);
}

void IgnorePngWarning(png_structp /*png*/, png_const_charp /*text*/) {}

class PngReader {
 public:
  explicit PngReader(std::string_view bytes)
      : rest_(bytes),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &message_, KeepPngMessage,
                                    IgnorePngWarning)),
        info_(png_ == nullptr ? nullptr : png_create_info_struct(png_)) {
    Check(info_ != nullptr, "there is no memory to decode a PNG");
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  ImageHeader ReadHeader() {
    if (setjmp(png_jmpbuf(png_)) != 0) {
      Fail();
    }
    png_set_read_fn(png_, this, ReadBytes);
    png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // the caller has a limit
    SkipText();
    png_read_info(png_, info_);
    return {.width = png_get_image_width(png_, info_),
            .height = png_get_image_height(png_, info_),
            .channels = png_get_channels(png_, info_),
            .bits = png_get_bit_depth(png_, info_),
            .has_palette = png_get_color_type(png_, info_) == PNG_COLOR_TYPE_PALETTE};
  }

  // `rows` are the rows of an image of this form.
  void ReadPixels(PixelForm form, std::vector<uint8_t*>& rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) {
      Fail();
    }
    if (std::endian::native == std::endian::little) {
      png_set_swap(png_);
    }
    png_set_strip_alpha(png_);
    if (form != PixelForm::kSixteenBit) {
      Transform(form);
    } else if ((png_get_color_type(png_, info_) & PNG_COLOR_MASK_COLOR) != 0) {
      png_set_bgr(png_);
    }
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    png_read_image(png_, rows.data());
  }

 private:
  // Text and palettes for other programs are skipped as they are: a megabyte of them may be a
  // gigabyte when it is decompressed. What may change values is read: gAMA, cHRM, sRGB and iCCP, of
  // which there is one each.
  void SkipText() {
    static constexpr char kSkipped[] =  // five bytes per name, with the zero
        "eXIf\0hIST\0iTXt\0oFFs\0pCAL\0pHYs\0sCAL\0sPLT\0tEXt\0tIME\0zTXt";
    constexpr int kNameBytes = 5;
    constexpr png_alloc_size_t kMostChunkBytes = 4'000'000;
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER,
                                reinterpret_cast<png_const_bytep>(kSkipped),
                                sizeof(kSkipped) / kNameBytes);
    png_set_chunk_malloc_max(png_, kMostChunkBytes);
  }

  static void ReadBytes(png_structp png, png_bytep bytes, size_t count) {
    auto& reader = *static_cast<PngReader*>(png_get_io_ptr(png));
    if (count > reader.rest_.size()) {
      reader.is_cut_off_ = true;
      png_error(png, "");
    }
    std::memcpy(bytes, reader.rest_.data(), count);
    reader.rest_.remove_prefix(count);
  }

  // The weights of red and green are from BT.601, as in all of OpenCV.
  void Transform(PixelForm form) {
    const int type = png_get_color_type(png_, info_);
    const bool has_colour = (type & PNG_COLOR_MASK_COLOR) != 0;
    png_set_strip_16(png_);
    if (type == PNG_COLOR_TYPE_PALETTE) {
      png_set_palette_to_rgb(png_);
    }
    if (!has_colour && png_get_bit_depth(png_, info_) < 8) {
      png_set_expand_gray_1_2_4_to_8(png_);
    }
    if (form == PixelForm::kGrey) {
      png_set_rgb_to_gray(png_, PNG_ERROR_ACTION_NONE, 0.299, 0.587);
    } else if (has_colour) {
      png_set_bgr(png_);
    } else {
      png_set_gray_to_rgb(png_);
    }
  }

  [[noreturn]] void Fail() const {
    if (is_cut_off_) {
      throw DecodeError(kCutOff);
    }
    throw DecodeError(std::string(kBroken) + message_.text.data());
  }

  std::string_view rest_;
  bool is_cut_off_ = false;
  PngMessage message_;
  png_structp png_;
  png_infop info_;
};

class PngWriter {
 public:
  PngWriter()
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, &message_, KeepPngMessage,
                                     IgnorePngWarning)),
        info_(png_ == nullptr ? nullptr : png_create_info_struct(png_)) {
    Check(info_ != nullptr, "there is no memory to encode a PNG");
  }
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  void Write(const cv::Mat& image, std::vector<uint8_t*>& rows, std::string& bytes) {
    if (setjmp(png_jmpbuf(png_)) != 0) {
      throw std::logic_error(message_.text.data());
    }
    png_set_write_fn(png_, &bytes, AddBytes, nullptr);
    png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_compression_level(png_, Z_BEST_SPEED);
    png_set_compression_strategy(png_, Z_RLE);
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(image.cols),
                 static_cast<png_uint_32>(image.rows), static_cast<int>(8 * image.elemSize1()),
                 image.channels() == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png_, info_);
    png_set_bgr(png_);
    if (std::endian::native == std::endian::little) {
      png_set_swap(png_);
    }
    png_write_image(png_, rows.data());
    png_write_end(png_, info_);
  }

 private:
  static void AddBytes(png_structp png, png_bytep bytes, size_t count) {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<char*>(bytes), count);
  }

  PngMessage message_;
  png_structp png_;
  png_infop info_;
};

std::vector<uint8_t*> RowsOf(const cv::Mat& image) {
  std::vector<uint8_t*> rows;
  for (int y = 0; y < image.rows; ++y) {
    rows.push_back(const_cast<uint8_t*>(image.ptr<uint8_t>(y)));  // libpng only reads from it
  }
  return rows;
}

}  // namespace

cv::Mat DecodePng(std::string_view bytes, PixelForm form, const HeaderCheck& check) {
  PngReader reader(bytes);
  const ImageHeader header = reader.ReadHeader();
  check(header);
  const int type = form == PixelForm::kSixteenBit ? (header.channels < 3 ? CV_16UC1 : CV_16UC3)
                   : form == PixelForm::kColour   ? CV_8UC3
                                                  : CV_8UC1;
  cv::Mat image(static_cast<int>(header.height), static_cast<int>(header.width), type);
  std::vector<uint8_t*> rows = RowsOf(image);
  reader.ReadPixels(form, rows);
  CheckChunks(bytes);
  return image;
}

std::string EncodePng(const cv::Mat& image) {
  Check((image.depth() == CV_8U || image.depth() == CV_16U) &&
            (image.channels() == 1 || image.channels() == 3) && !image.empty(),
        "a PNG is made of 8 or 16 bits and 1 or 3 channels");
  std::vector<uint8_t*> rows = RowsOf(image);
  std::string bytes;
  PngWriter().Write(image, rows, bytes);
  return bytes;
}

}  // namespace hullslam
