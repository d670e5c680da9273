#pragma once
// Pictures compared bit for bit.

#include "files/images/ImageReader.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace fenestra {

/// Expects the same channels, and the same sample count in the header, if it has one.
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

} // namespace fenestra
