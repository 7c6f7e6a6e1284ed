// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

struct Exchange {
  const char* request;
  const char* reply;
};
// One of every function code.
constexpr Exchange kExchanges[] = {
    {"01 00 64 00 08", "01 01 00"},
    {"02 00 64 00 08", "02 01 00"},
    {"03 00 64 00 02", "03 04 00 00 00 00"},
    {"04 00 64 00 02", "04 04 00 00 00 00"},
    {"05 00 66 FF 00", "05 00 66 FF 00"},
    {"06 00 9A 00 03", "06 00 9A 00 03"},
    {"08 00 00 A5 37", "08 00 00 A5 37"},
    {"0F 00 64 00 08 01 04", "0F 00 64 00 08"},
    {"10 00 8E 00 02 04 00 00 00 07", "10 00 8E 00 02"},
    {"16 00 9C 00 F2 00 25", "16 00 9C 00 F2 00 25"},
    {"17 00 64 00 01 00 9C 00 01 02 00 07", "17 02 00 00"},
    {"2B 0E 04 80", "2B 0E 04 83 00 00 01 80 01 33"},
    {"07", "87 01"},
};

TEST(Splits, EveryFunctionIsAnsweredTheSameAtEverySplit) {
  for (const Exchange& exchange : kExchanges) {
    const auto whole = frame(1, 1, bytes(exchange.request));
    for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
      Desk desk;
      Line plc(desk);
      const auto middle = whole.begin() + static_cast<std::ptrdiff_t>(cut);
      plc.feed({whole.begin(), middle});
      if (cut < whole.size()) {
        EXPECT_EQ(plc.session().output().size(), 0U);
      }
      plc.feed({middle, whole.end()});
      EXPECT_EQ(plc.reply(), exchange.reply) << exchange.request << " cut at " << cut;
      EXPECT_EQ(plc.reply(), "");
    }
  }
}

}  // namespace
}  // namespace axisgate::modbus_tcp::test
