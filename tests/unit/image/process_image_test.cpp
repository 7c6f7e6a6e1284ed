// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/process_image.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace axisgate {
namespace {

TEST(ProcessImage, FindsAxesByNumberAndListsThemInOrder) {
  ProcessImage image;
  AxisImage& fifth = image.add_axis(5, "five", 1);
  AxisImage& second = image.add_axis(2, "two", 0);
  EXPECT_EQ(image.find(5), &fifth);
  EXPECT_EQ(image.find(2), &second);
  EXPECT_EQ(image.find(3), nullptr);
  EXPECT_EQ(image.find(0), nullptr);
  EXPECT_EQ(image.find(65535), nullptr);
  ASSERT_EQ(image.axes().size(), 2U);
  EXPECT_EQ(image.axes()[0]->number, 2);
  EXPECT_EQ(image.axes()[1]->number, 5);
  EXPECT_EQ(image.axes()[1]->name, "five");
  EXPECT_EQ(image.axes()[1]->bus, 1);
}

TEST(ProcessImage, KeepsAxesWhereTheyAreWhenOthersCome) {
  ProcessImage image;
  const AxisImage* first = &image.add_axis(200, "a", 0);
  for (AxisNumber n = 1; n < 100; ++n) image.add_axis(n, "b", 0);
  EXPECT_EQ(image.find(200), first);
}

TEST(ProcessImage, AnAxisThatIsTakenOutIsSeenToGoAndWhatItDidHasEnded) {
  ProcessImage image;
  const AxisImage* const axis = &image.add_axis(3, "lift", 0);
  const std::uint32_t before = axis->sequence;
  const AxisRecord::Point since = axis->record.now();
  ChangeBoard::Reader reader(image.changes, [] {});
  axis->counts->faults = 7;
  image.remove_axis(3);
  std::size_t marked = 0;
  reader.take([&](std::size_t number) { marked = number; });
  EXPECT_EQ(marked, 3U);
  EXPECT_EQ(image.find(3), nullptr);
  EXPECT_EQ(&image.add_axis(3, "lift", 0), axis) << "whoever holds it may go on";
  EXPECT_EQ(axis->sequence, before + 1);
  EXPECT_TRUE(axis->record.interrupted(since, 1));
  EXPECT_EQ(axis->counts->faults, 7U) << "no counter goes back";
}

TEST(ChangeBoard, EachReaderFindsEveryMarkThatItHasNotTakenAndIsWokenOnce) {
  ChangeBoard board;
  int first_woken = 0;
  int second_woken = 0;
  ChangeBoard::Reader first(board, [&] { ++first_woken; });
  auto second = std::make_unique<ChangeBoard::Reader>(board, [&] { ++second_woken; });
  const auto taken = [](ChangeBoard::Reader& reader) {
    std::vector<std::size_t> out;
    reader.take([&](std::size_t axis) { out.push_back(axis); });
    return out;
  };
  board.mark(3);
  board.mark(1);
  EXPECT_EQ(taken(first), (std::vector<std::size_t>{1, 3}));
  board.mark(2);
  EXPECT_EQ(taken(first), (std::vector<std::size_t>{2}));
  EXPECT_EQ(first_woken, 2);
  EXPECT_EQ(taken(*second), (std::vector<std::size_t>{1, 2, 3})) << "a slow one misses nothing";
  EXPECT_EQ(second_woken, 1);
  second.reset();
  board.mark(4);
  EXPECT_EQ(taken(first), (std::vector<std::size_t>{4}));
  EXPECT_EQ(second_woken, 1);
}

TEST(ChangeBoard, AReaderThatLeavesAxesForLaterIsWokenByEachEventThatItTakes) {
  ChangeBoard board;
  int woken = 0;
  ChangeBoard::Reader reader(board, [&] { ++woken; });
  board.mark(3);
  board.mark(0);
  board.mark(0);
  EXPECT_EQ(woken, 2) << "once for axes, once for events";
  reader.take_event();
  board.mark(0);
  EXPECT_EQ(woken, 3);
  board.mark(4);
  EXPECT_EQ(woken, 3);
  EXPECT_TRUE(reader.any());
}

}  // namespace
}  // namespace axisgate
