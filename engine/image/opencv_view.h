#pragma once

#include <opencv2/core.hpp>

#include "engine/image/image.h"

namespace vs {

namespace internal {
template <class T>
struct CvType;
template <>
struct CvType<uint8_t> {
  static constexpr int kType = CV_8UC1;
};
template <>
struct CvType<uint16_t> {
  static constexpr int kType = CV_16UC1;
};
template <>
struct CvType<float> {
  static constexpr int kType = CV_32FC1;
};
template <>
struct CvType<Rgb> {
  static constexpr int kType = CV_8UC3;  // channel order r, g, b: OpenCV's files want b, g, r
};
}  // namespace internal

// The same pixels as an OpenCV matrix, without a copy. The matrix must not outlive the image.
template <class T>
cv::Mat CvView(Image<T>& image) {
  return cv::Mat(image.height(), image.width(), internal::CvType<T>::kType, image.Row(0),
                 image.stride_bytes());
}

// For reading only: OpenCV has no matrix of const pixels.
template <class T>
cv::Mat CvView(const Image<T>& image) {
  return cv::Mat(image.height(), image.width(), internal::CvType<T>::kType,
                 const_cast<T*>(image.Row(0)), image.stride_bytes());
}

}  // namespace vs
