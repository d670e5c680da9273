// When images of a 3D view are rendered and shown, under a clock of the test.

#include "FenestraLiveState.h"

#include <gtest/gtest.h>

namespace fenestra::core {
namespace {

using SlicerExport::LiveState;
using Phase = LiveState::Phase;

/// A live view with images that arrive `latency` after their request.
class SlicerLiveState : public ::testing::Test {
protected:
  /// Brings the state to the time of `now`, as its owner does.
  void advance() {
    requests += state.takeRequest(now) ? 1 : 0;
    images += state.takeImage(now) ? 1 : 0;
  }
  void advanceTo(double time) {
    for (; state.nextTime() <= time; advance())
      now = std::max(now, state.nextTime());
    now = time;
    advance();
  }

  LiveState state;
  double now = 100.0;
  int requests = 0, images = 0;
};

TEST_F(SlicerLiveState, OffNeverAsks) {
  state.moveCamera(now);
  state.turnOff();
  EXPECT_FALSE(state.isOn());
  EXPECT_EQ(state.nextTime(), LiveState::never);
  state.change(now);
  state.receive(true);
  advanceTo(200.0);
  EXPECT_EQ(requests + images, 0);
}

TEST_F(SlicerLiveState, TurnedOnItAsksAtOnceAndShowsTheFirstImageAtOnce) {
  state.turnOn(now);
  advance();
  EXPECT_EQ(requests, 1);
  EXPECT_EQ(state.phase(), Phase::waiting);
  EXPECT_EQ(state.nextTime(), LiveState::never);
  now += 0.05;
  state.receive(false);
  advance();
  EXPECT_EQ(images, 1);
  EXPECT_EQ(state.phase(), Phase::refining);
}

TEST_F(SlicerLiveState, TheFirstMoveAfterARestPauses) {
  EXPECT_FALSE(state.moveCamera(now)); // off: there is no renderer
  state.turnOff();
  state.turnOn(now);
  EXPECT_FALSE(state.moveCamera(now)); // nothing is requested yet
  advanceTo(now + 1.0);
  EXPECT_EQ(state.phase(), Phase::waiting);
  EXPECT_TRUE(state.moveCamera(now));
  EXPECT_FALSE(state.moveCamera(now));
  advanceTo(now + 1.0);
  state.receive(true);
  advance();
  EXPECT_EQ(state.phase(), Phase::done);
  EXPECT_TRUE(state.moveCamera(now));
}

TEST_F(SlicerLiveState, AsksOnceWhenTheCameraRests) {
  state.turnOn(now);
  advance();
  for (int i = 0; i < 50; ++i) {
    state.moveCamera(now);
    advanceTo(now + 0.1);
    EXPECT_EQ(state.phase(), Phase::turning);
  }
  EXPECT_EQ(requests, 1);
  advanceTo(now + 1.0);
  EXPECT_EQ(requests, 2);
  EXPECT_EQ(state.phase(), Phase::waiting);
}

TEST_F(SlicerLiveState, ImagesOfAnEarlierCameraAreDropped) {
  state.turnOn(now);
  advance();
  state.receive(false);
  state.moveCamera(now);
  advance();
  state.receive(true);
  advance();
  EXPECT_EQ(images, 0);
  EXPECT_EQ(state.phase(), Phase::turning);
}

TEST_F(SlicerLiveState, AtMostFiveRefreshesPerSecondAndTheLastIsShown) {
  state.turnOn(now);
  advance();
  const double start = now;
  for (int i = 1; i <= 100; ++i) {
    state.receive(i == 100);
    advanceTo(start + 0.01 * i);
  }
  EXPECT_LE(images, 6);
  EXPECT_GE(images, 4);
  advanceTo(now + 0.3);
  EXPECT_EQ(state.phase(), Phase::done);
  EXPECT_EQ(state.nextTime(), LiveState::never);
  EXPECT_EQ(requests, 1);
}

TEST_F(SlicerLiveState, AChangeAsksAgainButNotWhileTurning) {
  state.turnOn(now);
  advance();
  state.receive(true);
  advance();
  EXPECT_EQ(state.phase(), Phase::done);
  state.change(now);
  advance();
  EXPECT_EQ(requests, 2);
  EXPECT_EQ(state.phase(), Phase::waiting);
  state.moveCamera(now);
  state.change(now);
  advance();
  EXPECT_EQ(requests, 2);
  advanceTo(now + 0.2);
  EXPECT_EQ(requests, 3);
}

TEST_F(SlicerLiveState, ImagesAfterTheLastOneAreShown) {
  state.turnOn(now);
  advance();
  state.receive(true); // of data that have changed unnoticed
  advance();
  state.receive(false);
  advanceTo(now + 1.0);
  EXPECT_EQ(images, 2);
  EXPECT_EQ(state.phase(), Phase::refining);
}

TEST_F(SlicerLiveState, TheFirstImageOfANewCameraDoesNotWait) {
  state.turnOn(now);
  advance();
  state.receive(false);
  advance();
  state.moveCamera(now);
  advanceTo(now + LiveState::restSeconds);
  state.receive(false);
  advance();
  EXPECT_EQ(images, 2);
}

} // namespace
} // namespace fenestra::core
