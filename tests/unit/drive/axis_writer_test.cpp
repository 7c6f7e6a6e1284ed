// SPDX-License-Identifier: Apache-2.0
// An axis's image alone: which samples are made again, and until when they are good.
#include <gtest/gtest.h>

#include <utility>

#include "gateway/drive/axis/publisher.hpp"
#include "gateway/image/shown.hpp"
#include "tests/unit/drive/alone.hpp"

namespace axisgate::drive {
namespace {

using namespace std::chrono_literals;
using enum Quantity;

constexpr model::ObjectId kOfState = 0, kOfPosition = 1, kOfMode = 2;
constexpr Duration kPeriod = 200ms;

/// A position that is polled each 200 ms, and a mode that the gateway keeps itself.
class ImageOfAnAxis : public testing::Test {
 protected:
  ImageOfAnAxis() {
    image_.link_state = LinkState::online;
    writer_.show_state();
  }
  static model::DriveModel model_of_it() {
    model::DriveModel out;
    out.objects.resize(3);
    out.objects[kOfMode].emulated = true;
    out.objects[kOfPosition].size = 4;
    out.poll_period.fill(kPeriod);
    model::AxisModel axis;
    axis.statusword = kOfState;
    axis.state_sources = {kOfState};
    axis.binding_of.fill(-1);
    for (const auto& [quantity, object] : {std::pair(position_actual, kOfPosition), std::pair(mode, kOfMode)}) {
      model::Binding binding;
      binding.quantity = quantity;
      binding.object = object;
      binding.poll = model::PollClass::fast;
      binding.scaled = true;
      binding.raw_per_unit = Rational(1);
      axis.binding_of[static_cast<std::size_t>(quantity)] = static_cast<std::int16_t>(axis.bindings.size());
      axis.bindings.push_back(binding);
      axis.supported |= bit(quantity);
    }
    out.axes.push_back(axis);
    return out;
  }
  std::int64_t shown_after(Duration time) {
    turn_.now += time;
    writer_.show_state();
    return shown_value(image_, position_actual);
  }
  [[nodiscard]] bool good() const { return image_[position_actual].valid; }

  model::DriveModel model_ = model_of_it();
  ObjectStore store_{model_.objects};
  Turn turn_{.now = kStart, .link = LinkState::online};
  AxisImage image_;
  AxisCore core_{model_, model_.axes[0], store_, turn_, Motion{model_.axes[0].velocity_lag, image_.record}};
  AxisWriter writer_{core_, image_};
};

TEST_F(ImageOfAnAxis, IsGoodFromItsSampleUntilItIsStaleAndAgainWithTheNext) {
  EXPECT_FALSE(good());
  EXPECT_EQ(writer_.stale_at(), kNever);
  store_.read(kOfPosition, 7, turn_.now);
  EXPECT_EQ(shown_after(0ms), 7);
  EXPECT_TRUE(good());
  const Instant stale = writer_.stale_at();
  EXPECT_EQ(stale, kStart + 3 * kPeriod + Duration{1});
  EXPECT_EQ(shown_after(3 * kPeriod), 7);
  EXPECT_TRUE(good());
  EXPECT_EQ(shown_after(Duration{1}), 7) << "the last number stays";
  EXPECT_FALSE(good());
  EXPECT_EQ(writer_.stale_at(), kNever);
  store_.read(kOfPosition, 7, turn_.now);
  EXPECT_EQ(shown_after(0ms), 7);
  EXPECT_TRUE(good());
}

TEST_F(ImageOfAnAxis, IsGoodAsLongAsItIsSaidToBeConfirmedSo) {
  store_.read(kOfPosition, 7, turn_.now);
  writer_.show_state();
  store_.set_period(kOfPosition, 1s);
  EXPECT_EQ(shown_after(3s), 7);
  EXPECT_TRUE(good());
}

TEST_F(ImageOfAnAxis, HasAKeptModeBesideItThatIsAsYoungAsTheState) {
  store_.make(kOfMode, 3);
  store_.read(kOfState, 0x0237, turn_.now);
  static_cast<void>(shown_after(1s));
  EXPECT_EQ(image_[mode].at, kStart);
  EXPECT_FALSE(image_[mode].valid);
  store_.read(kOfState, 0x0237, turn_.now);
  writer_.show_state();
  EXPECT_EQ(image_[mode].at, kStart + 1s);
  EXPECT_TRUE(image_[mode].valid);
}

TEST_F(ImageOfAnAxis, IsNotGoodWhileTheDriveIsOutOfReach) {
  store_.read(kOfPosition, 7, turn_.now);
  image_.link_state = LinkState::offline;
  writer_.show_state();
  EXPECT_FALSE(good());
  image_.link_state = LinkState::online;
  writer_.show_state();
  EXPECT_TRUE(good());
}

TEST_F(ImageOfAnAxis, IsOfTheScaleThatTheDriveIsKnownToHaveNow) {
  store_.read(kOfPosition, 8, turn_.now);
  EXPECT_EQ(shown_after(0ms), 8);
  model_.axes[0].bindings[0].raw_per_unit = Rational(2);
  writer_.show_model();
  EXPECT_EQ(shown_after(0ms), 4);
}

TEST_F(ImageOfAnAxis, IsSupportedUnlessTheDriveRefusesIt) {
  EXPECT_TRUE(image_.supports(position_actual));
  store_.refused(kOfPosition);
  writer_.show_state();
  EXPECT_FALSE(image_.supports(position_actual));
  store_.forget(kOfPosition);
  writer_.show_state();
  EXPECT_TRUE(image_.supports(position_actual));
}

}  // namespace
}  // namespace axisgate::drive
