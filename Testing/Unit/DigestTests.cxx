#include "io/Digest.h"

#include "Refusals.h"

#include <string>

namespace fenestra::core::testing::DigestTests {
namespace {

std::uint64_t digestInSteps(const std::string& text, std::size_t step) {
  Digest digest;
  for (std::size_t at = 0; at < text.size(); at += step)
    digest.add(std::string_view(text).substr(at, step));
  return digest.value();
}

TEST(Digest, DependsOnTheBytesNotOnTheirDivision) {
  std::string text;
  for (int i = 0; i < 1000; ++i)
    text += static_cast<char>(i * i);
  for (const std::size_t step : {1U, 3U, 7U, 8U, 9U, 64U})
    EXPECT_EQ(digestInSteps(text, step), digestInSteps(text, text.size()));
  const TemporaryFolder folder;
  EXPECT_EQ(computeDigest(folder.write("a", text)), digestInSteps(text, 1));
  EXPECT_EQ(computeDigest(folder / "a", 77), digestInSteps(text.substr(0, 77), 1));
}

TEST(Digest, ChangesWithEveryBitAndTheLength) {
  const std::string text(40, '\0');
  for (std::size_t bit = 0; bit < 8 * text.size(); ++bit) {
    std::string other = text;
    other[bit / 8] = static_cast<char>(1U << bit % 8);
    EXPECT_NE(digestInSteps(other, 40), digestInSteps(text, 40));
  }
  EXPECT_NE(digestInSteps(text + '\0', 41), digestInSteps(text, 40));
  EXPECT_NE(digestInSteps("", 1), digestInSteps(std::string(8, '\0'), 8));
}

TEST(Digest, NeverChanges) { // checkpoints and manifests of earlier runs contain it
  EXPECT_EQ(digestInSteps("fenestra", 8), 7811035952669358778ULL);
}

TEST(Digest, MissingFileIsRejected) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "none";
  expectRefused(path, "unreadable-file", [&] { computeDigest(path); });
}

} // namespace
} // namespace fenestra::core::testing::DigestTests
