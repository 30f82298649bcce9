// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/texture_painter.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "synthetic/hash_noise.h"

namespace hullslam::synthetic {
namespace {

// In the functions below each random number is drawn in a statement of its own, because C++ does
// not specify in which order the arguments of a call are evaluated. So the images do not depend on
// the compiler.
cv::Point RandomPixel(RandomStream& random, int size) {
  const int y = random.Index(size);
  const int x = random.Index(size);
  return {x, y};
}

cv::Scalar RandomColour(RandomStream& random, double low, double high) {
  // Printed colours are not pure, so each is halfway to grey.
  const double grey = 0.5 * random.Uniform(low, high);
  const double b = 0.5 * random.Uniform(low, high);
  const double g = 0.5 * random.Uniform(low, high);
  const double r = 0.5 * random.Uniform(low, high);
  return {grey + b, grey + g, grey + r};
}

cv::Mat Canvas(int size, const cv::Scalar& colour) { return {size, size, CV_8UC3, colour}; }

// Adds noise with a standard deviation of `contrast` (grey levels), the same to all three colours.
void AddNoise(uint64_t seed, int period, int octaves, double contrast, cv::Mat& image) {
  const cv::Mat noise = PaintNoise(seed, image.rows, period, octaves);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      for (int c = 0; c < 3; ++c) {
        uint8_t& value = image.at<cv::Vec3b>(y, x)[c];
        value = cv::saturate_cast<uint8_t>(value + contrast * noise.at<float>(y, x));
      }
    }
  }
}

// Calls `draw(offset)` for the original position and for its copies beyond the borders, so that a
// figure that is cut off at one side continues at the opposite side.
template <typename Draw>
void Tiled(int size, const Draw& draw) {
  for (const int dy : {-size, 0, size}) {
    for (const int dx : {-size, 0, size}) {
      draw(cv::Point(dx, dy));
    }
  }
}

std::string RandomWord(RandomStream& random) {
  std::string word(static_cast<size_t>(2 + random.Index(7)), ' ');
  for (char& letter : word) {
    letter = static_cast<char>('a' + random.Index(26));
  }
  if (random.Index(4) == 0) {
    word[0] = static_cast<char>(word[0] - 'a' + 'A');
  }
  return word;
}

// Draws lines of words inside `box`, with letters about `height` px high.
void WriteText(RandomStream& random, const cv::Rect& box, int height, const cv::Scalar& ink,
               cv::Mat& image) {
  const double scale = height / 22.0;
  const int thickness = std::max(1, height / 12);
  for (int y = box.y + height; y < box.y + box.height; y += height * 8 / 5) {
    int x = box.x;
    while (x < box.x + box.width) {
      const std::string word = RandomWord(random);
      int baseline = 0;
      const cv::Size extent =
          cv::getTextSize(word, cv::FONT_HERSHEY_DUPLEX, scale, thickness, &baseline);
      if (x + extent.width > box.x + box.width) {
        break;
      }
      cv::putText(image, word, {x, y}, cv::FONT_HERSHEY_DUPLEX, scale, ink, thickness, cv::LINE_AA);
      x += extent.width + height * 2 / 3;
    }
  }
}

void DrawFigure(RandomStream& random, double reach, cv::Mat& image) {
  const int size = image.rows;
  const cv::Scalar colour = RandomColour(random, 15.0, 240.0);
  const double centre_y = random.Uniform(0.0, size);
  const double centre_x = random.Uniform(0.0, size);
  const cv::Point2d centre(centre_x, centre_y);
  const double radius = reach * size;
  const int corners = 2 + random.Index(4);
  if (corners == 2) {
    cv::circle(image, centre, static_cast<int>(radius), colour, cv::FILLED, cv::LINE_AA);
    return;
  }
  std::vector<cv::Point> polygon;
  const double turn = random.Uniform(0.0, 2.0 * CV_PI);
  for (int i = 0; i < corners; ++i) {
    const double angle = turn + 2.0 * CV_PI * i / corners;
    const double r = radius * random.Uniform(0.7, 1.3);
    polygon.emplace_back(static_cast<int>(centre.x + r * std::cos(angle)),
                         static_cast<int>(centre.y + r * std::sin(angle)));
  }
  cv::fillPoly(image, std::vector<std::vector<cv::Point>>{polygon}, colour, cv::LINE_AA);
}

}  // namespace

cv::Mat PaintNoise(uint64_t seed, int size, int period, int octaves) {
  cv::Mat sum(size, size, CV_32FC1, cv::Scalar(0));
  float strength = 0.6F;
  for (int octave = 0; octave < octaves && period <= size; ++octave) {
    std::vector<float> lattice(static_cast<size_t>(period) * static_cast<size_t>(period));
    for (size_t i = 0; i < lattice.size(); ++i) {
      const uint64_t word = CounterHash(seed + static_cast<uint64_t>(octave), i);
      lattice[i] = static_cast<float>(2.0 * UnitInterval(word) - 1.0);
    }
    const int cell = size / period;
    const auto smooth = [&](int i) {
      const float t = (static_cast<float>(i % cell) + 0.5F) / static_cast<float>(cell);
      return t * t * (3.0F - 2.0F * t);
    };
    std::vector<float> weight(static_cast<size_t>(size));
    for (int i = 0; i < size; ++i) {
      weight[static_cast<size_t>(i)] = smooth(i);
    }
    for (int y = 0; y < size; ++y) {
      auto* row = sum.ptr<float>(y);
      const float* upper = &lattice[static_cast<size_t>(y / cell * period)];
      const float* lower = &lattice[static_cast<size_t>((y / cell + 1) % period * period)];
      const float fy = weight[static_cast<size_t>(y)];
      for (int x = 0; x < size; ++x) {
        const int left = x / cell;
        const int right = left + 1 < period ? left + 1 : 0;
        const float fx = weight[static_cast<size_t>(x)];
        const float top = upper[left] + fx * (upper[right] - upper[left]);
        const float bottom = lower[left] + fx * (lower[right] - lower[left]);
        row[x] += strength * (top + fy * (bottom - top));
      }
    }
    strength *= 0.62F;
    period *= 2;
  }
  return sum;
}

cv::Mat PaintPlain(uint64_t seed, int size, const cv::Scalar& colour, double contrast) {
  cv::Mat image = Canvas(size, colour);
  AddNoise(seed, 2, 6, contrast, image);
  return image;
}

cv::Mat PaintPlaster(uint64_t seed, int size, const cv::Scalar& colour) {
  RandomStream random(seed);
  cv::Mat image = Canvas(size, colour);
  for (int i = 0; i < 320; ++i) {
    const cv::Point at = RandomPixel(random, size);
    const double radius = size * 0.006 * std::pow(random.Uniform(0.05, 1.0), 2.5);
    const cv::Size axes(static_cast<int>(1.0 + radius * random.Uniform(0.6, 3.0)),
                        static_cast<int>(1.0 + radius));
    const double angle = random.Uniform(0.0, 180.0);
    const cv::Scalar chip = colour * random.Uniform(0.5, 1.15);
    Tiled(size, [&](const cv::Point& offset) {
      cv::ellipse(image, at + offset, axes, angle, 0.0, 360.0, chip, cv::FILLED, cv::LINE_AA);
    });
  }
  AddNoise(seed, 4, 8, 38.0, image);
  return image;
}

cv::Mat PaintBrick(uint64_t seed, int size) {
  RandomStream random(seed);
  cv::Mat image = Canvas(size, cv::Scalar(150, 160, 168));
  const int rows = 16;
  const int columns = 6;
  const int height = size / rows;
  const int width = size / columns;
  const int joint = std::max(2, size / 170);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double shade = random.Uniform(0.6, 1.25);
      const cv::Scalar colour(62 * shade, 82 * shade, 150 * shade);
      const cv::Point corner(column * size / columns + (row % 2) * width / 2, row * height);
      Tiled(size, [&](const cv::Point& offset) {
        const cv::Rect brick(corner + offset, cv::Size(width - joint, height - joint));
        cv::rectangle(image, brick, colour, cv::FILLED);
      });
    }
  }
  AddNoise(seed, 8, 7, 38.0, image);
  return image;
}

cv::Mat PaintWood(uint64_t seed, int size, const cv::Scalar& colour) {
  RandomStream random(seed);
  cv::Mat image(size, size, CV_8UC3);
  const int boards = 8;
  const cv::Mat bend = PaintNoise(seed + 100, size, 4, 3);
  const cv::Mat fine = PaintNoise(seed + 200, size, 64, 4);
  for (int y = 0; y < size; ++y) {
    const int board = y * boards / size;
    const double tone = 0.85 + 0.3 * UnitInterval(CounterHash(seed + 300, board));
    const bool gap = (y * boards) % size < boards * size / 256;
    for (int x = 0; x < size; ++x) {
      const double across = y + 30.0 * bend.at<float>(y, x) + 37.0 * board;
      const double grain = std::sin(across * 2.0 * CV_PI * 40.0 / size);
      const double value = gap ? 0.35 : tone * (1.0 + 0.09 * grain) + 0.14 * fine.at<float>(y, x);
      for (int c = 0; c < 3; ++c) {
        image.at<cv::Vec3b>(y, x)[c] = cv::saturate_cast<uint8_t>(colour[c] * value);
      }
    }
  }
  for (int i = 0; i < 90; ++i) {  // knots, stains and scratches
    const cv::Point at = RandomPixel(random, size);
    const int height = 1 + random.Index(size / 120);
    const int width = 2 + random.Index(size / 50);
    const cv::Size axes(width, height);
    const cv::Scalar dark = colour * random.Uniform(0.4, 0.75);
    Tiled(size, [&](const cv::Point& offset) {
      cv::ellipse(image, at + offset, axes, 0.0, 0.0, 360.0, dark, cv::FILLED, cv::LINE_AA);
    });
  }
  AddNoise(seed, 16, 6, 16.0, image);
  return image;
}

cv::Mat PaintFabric(uint64_t seed, int size, const cv::Scalar& colour) {
  RandomStream random(seed);
  cv::Mat image = Canvas(size, colour);
  for (int i = 0; i < 160; ++i) {
    const cv::Point at = RandomPixel(random, size);
    const int width = 3 + random.Index(size / 14);
    const int height = 3 + random.Index(size / 14);
    const cv::Scalar patch = colour * random.Uniform(0.5, 1.5);
    Tiled(size, [&](const cv::Point& offset) {
      cv::rectangle(image, cv::Rect(at + offset, cv::Size(width, height)), patch, cv::FILLED);
    });
  }
  AddNoise(seed, size / 16, 4, 30.0, image);
  return image;
}

cv::Mat PaintSpeckle(uint64_t seed, int size, const cv::Scalar& colour) {
  RandomStream random(seed);
  cv::Mat image = Canvas(size, colour);
  for (int i = 0; i < 500; ++i) {
    const cv::Point at = RandomPixel(random, size);
    const int radius = 1 + static_cast<int>(size * 0.03 * std::pow(random.Uniform(0.1, 1.0), 3.0));
    const cv::Scalar spot = colour * random.Uniform(0.35, 1.55);
    Tiled(size, [&](const cv::Point& offset) {
      cv::circle(image, at + offset, radius, spot, cv::FILLED, cv::LINE_AA);
    });
  }
  AddNoise(seed, 8, 6, 22.0, image);
  return image;
}

cv::Mat PaintChecker(uint64_t seed, int size, int cells) {
  RandomStream random(seed);
  cv::Mat image = Canvas(size, cv::Scalar(0, 0, 0));
  const int cell = size / cells;
  for (int y = 0; y < cells; ++y) {
    for (int x = 0; x < cells; ++x) {
      const double base = (x + y) % 2 == 0 ? 70.0 : 190.0;
      cv::rectangle(image, cv::Rect(x * cell, y * cell, cell, cell),
                    RandomColour(random, base - 50.0, base + 50.0), cv::FILLED);
    }
  }
  AddNoise(seed, 16, 5, 18.0, image);
  return image;
}

cv::Mat PaintPoster(uint64_t seed, int size) {
  RandomStream random(seed);
  cv::Mat image = Canvas(size, RandomColour(random, 90.0, 230.0));
  for (int i = 0; i < 130; ++i) {
    DrawFigure(random, 0.16 / (1.0 + 0.10 * i), image);
  }
  for (int i = 0; i < 4; ++i) {
    const int height = size / 40 + random.Index(size / 16);
    const int top = random.Index(size * 7 / 8);
    const int left = random.Index(size / 2);
    const cv::Rect box(left, top, size / 2, height + 2);
    WriteText(random, box, height, RandomColour(random, 0.0, 255.0), image);
  }
  for (int i = 0; i < 120; ++i) {
    const cv::Point at = RandomPixel(random, size);
    const cv::Scalar dot = RandomColour(random, 0.0, 255.0);
    const int radius = 2 + random.Index(5);
    cv::circle(image, at, radius, dot, cv::FILLED, cv::LINE_AA);
  }
  AddNoise(seed, 16, 5, 9.0, image);
  cv::rectangle(image, cv::Rect(0, 0, size, size), cv::Scalar(235, 238, 240), size / 24);
  return image;
}

cv::Mat PaintPage(uint64_t seed, int size) {
  RandomStream random(seed);
  cv::Mat image = Canvas(size, cv::Scalar(215, 226, 232));
  const int margin = size / 16;
  const cv::Scalar ink(38, 34, 34);
  const int width = size - 2 * margin;
  WriteText(random, {margin, margin, width, size / 9}, size / 11, ink, image);
  const cv::Rect picture(size / 2, size / 4, size / 2 - margin, size / 3);
  WriteText(random, {margin, size / 4, size / 2 - 2 * margin, size / 3}, size / 32, ink, image);
  cv::Mat region = image(picture);
  cv::resize(PaintPoster(seed + 1, size / 2), region, picture.size(), 0, 0, cv::INTER_AREA);
  WriteText(random, {margin, size * 5 / 8, width, size / 3}, size / 32, ink, image);
  AddNoise(seed, 8, 6, 8.0, image);
  return image;
}

cv::Mat PaintKeys(uint64_t seed, int size) {
  RandomStream random(seed);
  cv::Mat image = Canvas(size, cv::Scalar(40, 38, 38));
  const int rows = 5;
  const int columns = 15;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const int x = size / 40 + column * (size - size / 20) / columns;
      const int y = size / 20 + row * (size - size / 10) / rows;
      const cv::Rect key(x, y, size / columns - size / 60, size / rows - size / 18);
      cv::rectangle(image, key, cv::Scalar(78, 76, 74) * random.Uniform(0.8, 1.2), cv::FILLED);
      const std::string mark(1, static_cast<char>('A' + random.Index(26)));
      cv::putText(image, mark, {key.x + key.width / 4, key.y + key.height * 2 / 3},
                  cv::FONT_HERSHEY_DUPLEX, size / 1000.0, cv::Scalar(225, 225, 225), 1,
                  cv::LINE_AA);
    }
  }
  AddNoise(seed, 16, 5, 6.0, image);
  return image;
}

cv::Mat PaintScreen(uint64_t seed, int size) {
  RandomStream random(seed);
  cv::Mat image = PaintPlain(seed, size, cv::Scalar(120, 84, 50), 30.0);
  for (int i = 0; i < 5; ++i) {
    const cv::Rect window(random.Index(size / 2), random.Index(size / 2),
                          size / 4 + random.Index(size / 4), size / 4 + random.Index(size / 4));
    const cv::Scalar paper = RandomColour(random, 190.0, 245.0);
    cv::rectangle(image, window, i % 2 == 0 ? paper : cv::Scalar(48, 44, 40), cv::FILLED);
    cv::rectangle(image, cv::Rect(window.x, window.y, window.width, size / 30),
                  RandomColour(random, 60.0, 200.0), cv::FILLED);
    const cv::Rect text(window.x + 6, window.y + size / 24, window.width - 12,
                        window.height - size / 20);
    WriteText(random, text, size / 40, i % 2 == 0 ? cv::Scalar(30, 30, 30) : paper, image);
  }
  cv::rectangle(image, cv::Rect(0, 0, size, size), cv::Scalar(24, 24, 26), size / 20);
  return image;
}

}  // namespace hullslam::synthetic
