// SPDX-License-Identifier: Apache-2.0
#include "gateway/image/events.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace axisgate {
namespace {

TEST(EventRing, TellsEachEventOnceAsItIsAdded) {
  std::vector<std::string> told;
  EventRing ring([&](const Event& event) { told.push_back(event.text); });
  ring.add(Instant{}, 1, EventKind::fault, 0x2310, "overcurrent");
  ring.add(Instant{}, 0, EventKind::link, 0, "bus up");
  EXPECT_EQ(told, (std::vector<std::string>{"overcurrent", "bus up"}));
  EXPECT_EQ(ring.events().front().code, 0x2310U);
}

TEST(EventRing, KeepsTheNewestThousandAndLetsAReaderCountWhatItMissed) {
  EventRing ring;
  for (int i = 0; i < 1500; ++i) ring.add(Instant{}, 1, EventKind::command, 0, "");
  EXPECT_EQ(ring.events().size(), kMaxEvents);
  EXPECT_EQ(ring.added(), 1500U);
  ring.add(Instant{}, 1, EventKind::fault, 0, "");
  EXPECT_EQ(ring.added_by_kind()[static_cast<std::size_t>(EventKind::command)], 1500U);
  EXPECT_EQ(ring.added_by_kind()[static_cast<std::size_t>(EventKind::fault)], 1U);
  EXPECT_EQ(ring.events().front().number, 502U);
  EXPECT_EQ(ring.events().back().number, 1501U);
}

}  // namespace
}  // namespace axisgate
