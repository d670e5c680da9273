#pragma once
// Bitwise comparison of images.

#include "files/images/ImageReader.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace fenestra::core {

/// Expects equal channels and, if the headers have one, an equal sample count.
inline void expectSameImage(const std::filesystem::path& a, const std::filesystem::path& b) {
  const Image one = readImage(a), other = readImage(b);
  EXPECT_FALSE(one.channels.empty());
  EXPECT_TRUE(one.channels == other.channels) << a << " and " << b;
  const auto samples = [](const Image& image) {
    const auto found = image.header.find("samples");
    return found == image.header.end() ? std::string() : found->second;
  };
  EXPECT_EQ(samples(one), samples(other));
}

} // namespace fenestra::core
