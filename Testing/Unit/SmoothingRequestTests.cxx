#include "model/filtering/SmoothingRequest.h"

#include <gtest/gtest.h>

namespace fenestra::core {
namespace {

using Kind = SmoothingRequest::Kind;

TEST(SmoothingRequest, AutomaticSmoothsWhatIsDisplayed) {
  const SmoothingRequest automatic{Kind::automatic};
  EXPECT_TRUE(isSmoothed(automatic, {.hasDisplayImage = true}));
  EXPECT_TRUE(isSmoothed(automatic, {.isServer = true}));
  EXPECT_FALSE(isSmoothed(automatic, {}));
  EXPECT_FALSE(isSmoothed(automatic, {.hasDisplayImage = true, .isShard = true}));
}

TEST(SmoothingRequest, OtherKindsHoldForEveryPurpose) {
  for (const bool isTrue : {false, true}) {
    const SmoothingPurpose purpose{isTrue, !isTrue, isTrue};
    EXPECT_FALSE(isSmoothed({Kind::off}, purpose));
    EXPECT_TRUE(isSmoothed({Kind::given, 20.0}, purpose));
  }
}

} // namespace
} // namespace fenestra::core
