// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace hullslam::synthetic {

// Procedural textures: CV_8UC3, BGR, square, `size` (a power of two) wide. Textures of surfaces
// repeat without a seam; posters, pages and screens are single pictures. All textures have detail
// over several octaves, so that corners are found at all levels of an image pyramid.

// Sum of `octaves` octaves of value noise, about -1 to 1, CV_32FC1. The first octave has `period`
// cells across the image; each following one has twice as many cells and half the strength.
cv::Mat PaintNoise(uint64_t seed, int size, int period, int octaves);

// One colour plus noise with a standard deviation of `contrast` (grey levels).
cv::Mat PaintPlain(uint64_t seed, int size, const cv::Scalar& colour, double contrast);
// Plaster with stains, chips and cracks.
cv::Mat PaintPlaster(uint64_t seed, int size, const cv::Scalar& colour);
cv::Mat PaintBrick(uint64_t seed, int size);
// Boards along u with grain and knots.
cv::Mat PaintWood(uint64_t seed, int size, const cv::Scalar& colour);
// Carpet or upholstery with a pattern of patches.
cv::Mat PaintFabric(uint64_t seed, int size, const cv::Scalar& colour);
// A speckled surface: fur, stone, a printed ball.
cv::Mat PaintSpeckle(uint64_t seed, int size, const cv::Scalar& colour);
// Coloured squares.
cv::Mat PaintChecker(uint64_t seed, int size, int cells);
// A printed picture of overlapping figures, dots and words.
cv::Mat PaintPoster(uint64_t seed, int size);
// A printed page: a title and lines of words.
cv::Mat PaintPage(uint64_t seed, int size);
// Keys in rows with marks on them.
cv::Mat PaintKeys(uint64_t seed, int size);
// A computer's screen: windows with text and pictures.
cv::Mat PaintScreen(uint64_t seed, int size);

}  // namespace hullslam::synthetic
