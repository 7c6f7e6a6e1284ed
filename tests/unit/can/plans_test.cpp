// SPDX-License-Identifier: Apache-2.0
// What is worked out without a socket: bus-off, errors, filters, what waits to be sent, devices and their mistakes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can/error.h>

#include <cerrno>

#include "adapters/can/can_bus_off_plan.hpp"
#include "adapters/can/can_device.hpp"
#include "adapters/can/can_error.hpp"
#include "adapters/can/can_filter_set.hpp"
#include "adapters/can/can_send_queue.hpp"
#include "adapters/can/link/raw_socket.hpp"

namespace axisgate::can {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using Health = BusOffPlan::Health;

class BusOffPlanTest : public testing::Test {
 protected:
  void tell(const CanErrors& errors) { plan.on_errors(errors, now, trouble); }
  void bus_off() { tell({.bus_off = true}); }
  void restarted() { tell({.restarted = true}); }
  [[nodiscard]] Health health() const { return plan.health(now); }

  Instant now = Instant{} + 1h;
  BusOffPlan plan;
  CanTrouble trouble;
};

TEST_F(BusOffPlanTest, bus_off_counts_at_once_and_until_the_controller_runs_again) {
  EXPECT_EQ(health(), Health::usable);
  EXPECT_EQ(plan.due(now), kNever);
  for (const CanErrors& runs_again : {CanErrors{.restarted = true}, CanErrors{.error_active = true}}) {
    bus_off();
    now += 24h;
    EXPECT_EQ(health(), Health::bus_off) << "no time heals a controller that nobody restarts";
    for (const CanErrors& other : {CanErrors{.no_ack = true}, CanErrors{.error_passive = true},
                                   CanErrors{.protocol_error = true}, CanErrors{.error_warning = true}}) {
      tell(other);
      EXPECT_EQ(health(), Health::bus_off) << text(other);
    }
    tell(runs_again);
    EXPECT_EQ(health(), Health::usable) << text(runs_again);
  }
}

TEST_F(BusOffPlanTest, a_controller_found_standing_still_is_bus_off_until_it_runs) {
  plan.on_found_stopped();
  EXPECT_EQ(health(), Health::bus_off);
  plan.on_restart();
  EXPECT_EQ(health(), Health::usable);
  EXPECT_EQ(trouble.bus_offs, 0) << "nobody saw it happen";
}

TEST_F(BusOffPlanTest, five_bus_offs_in_a_minute_are_borne_and_any_number_over_more) {
  for (const auto& [times, pause] : {std::pair(5, Duration(1s)), std::pair(20, Duration(12001ms))}) {
    now += 1h;
    for (int i = 0; i < times; ++i, now += pause) {
      bus_off();
      restarted();
      EXPECT_EQ(health(), Health::usable) << i;
    }
  }
  EXPECT_EQ(trouble.bus_offs, 25);
}

TEST_F(BusOffPlanTest, the_sixth_within_a_minute_gives_the_bus_up_for_a_minute_of_quiet) {
  for (int i = 0; i < 6; ++i, now += 12s) {
    bus_off();
    restarted();
  }
  const Instant last = now - 12s;
  EXPECT_EQ(health(), Health::given_up);
  EXPECT_EQ(plan.due(now), last + 60s);
  now = last + 30s;
  bus_off();
  restarted();
  now = last + 89s;
  EXPECT_EQ(health(), Health::given_up) << "each further bus-off begins the minute anew";
  now = last + 90s;
  EXPECT_EQ(health(), Health::usable);
  for (int i = 0; i < 6; ++i) bus_off();
  now += 61s;
  EXPECT_EQ(health(), Health::bus_off) << "it was not restarted";
}

TEST_F(BusOffPlanTest, a_sender_that_nobody_hears_is_told_after_half_a_second_and_with_a_full_queue_at_once) {
  tell({.no_ack = true});
  EXPECT_EQ(health(), Health::usable) << "one frame without acknowledgement is no reason";
  tell({.no_ack = true, .error_passive = true});
  const Instant since = now;
  EXPECT_EQ(plan.due(now), since + 500ms);
  for (; now < since + 500ms; now += 100ms) {
    tell({.no_ack = true});
    EXPECT_EQ(health(), Health::usable);
  }
  EXPECT_EQ(health(), Health::no_ack);
  plan = {};
  tell({.no_ack = true, .error_passive = true});
  plan.on_queue_full();
  EXPECT_EQ(health(), Health::no_ack);
}

TEST_F(BusOffPlanTest, a_full_queue_alone_says_nothing_about_acknowledgements) {
  plan.on_queue_full();
  EXPECT_EQ(health(), Health::usable);
  tell({.error_passive = true});
  plan.on_queue_full();
  now += 10s;
  EXPECT_EQ(health(), Health::usable) << "a receiver may be error passive, too";
  tell({.no_ack = true});
  EXPECT_EQ(health(), Health::usable) << "what was full before the missing acknowledgement is forgotten";
}

TEST_F(BusOffPlanTest, no_acknowledgement_lasts_as_long_as_the_controller_complains_or_until_a_sign_of_life) {
  const std::pair<const char*, std::function<void()>> ends[] = {
      {"a second of quiet", [this] { now += 1s + Duration(1); }},
      {"a frame from anybody, and it needs its time to come back",
       [this] {
         plan.on_frame();
         tell({.no_ack = true});
       }},
      {"recovery", [this] { tell({.error_warning = true}); }},
      {"a restart", [this] { plan.on_restart(); }},
  };
  for (const auto& [what, end] : ends) {
    SCOPED_TRACE(what);
    plan = {};
    tell({.no_ack = true, .error_passive = true});
    plan.on_queue_full();
    for (int i = 0; i < 20; ++i, now += 900ms) {
      EXPECT_EQ(health(), Health::no_ack);
      tell({.no_ack = true});
    }
    EXPECT_EQ(plan.due(now), now + 100ms + Duration(1)) << "a second after the last complaint";
    now -= 900ms;
    end();
    EXPECT_EQ(health(), Health::usable);
    tell({.no_ack = true, .error_passive = true});
    plan.on_queue_full();
    bus_off();
    EXPECT_EQ(health(), Health::bus_off) << "the greater trouble";
  }
}

TEST_F(BusOffPlanTest, counts_what_it_is_told) {
  tell({.no_ack = true, .error_passive = true});
  tell({.no_ack = true, .error_passive = true});
  tell({.error_active = true});
  tell({.error_passive = true});
  tell({.receive_overflow = true});
  bus_off();
  EXPECT_EQ(trouble.error_frames, 6);
  EXPECT_EQ(trouble.no_ack, 2);
  EXPECT_EQ(trouble.error_passive, 2) << "times it went error passive, not frames that say so";
  EXPECT_EQ(trouble.bus_offs, 1);
  EXPECT_EQ(trouble.lost_in, 1);
}

TEST(BusOffPlanText, says_what_to_look_at) {
  EXPECT_THAT(text(Health::no_ack), HasSubstr("nobody acknowledges"));
  EXPECT_THAT(text(Health::bus_off), HasSubstr("termination"));
  EXPECT_THAT(text(Health::given_up), HasSubstr("more than 5 times in a minute"));
}

// --- Errors ---------------------------------------------------------------------------------------------------------

static_assert(error_class::kTxTimeout == CAN_ERR_TX_TIMEOUT && error_class::kLostArbitration == CAN_ERR_LOSTARB &&
              error_class::kController == CAN_ERR_CRTL && error_class::kProtocol == CAN_ERR_PROT &&
              error_class::kTransceiver == CAN_ERR_TRX && error_class::kNoAck == CAN_ERR_ACK &&
              error_class::kBusOff == CAN_ERR_BUSOFF && error_class::kBusError == CAN_ERR_BUSERROR &&
              error_class::kRestarted == CAN_ERR_RESTARTED && error_class::kCounters == CAN_ERR_CNT);

TEST(CanError, each_class_says_what_it_means) {
  struct Case {
    std::uint32_t classes;
    std::array<Byte, 8> data;
    CanErrors expected;
    const char* words;
  };
  const Case cases[] = {
      {CAN_ERR_BUSOFF, {}, {.bus_off = true}, "bus-off"},
      {CAN_ERR_RESTARTED, {}, {.restarted = true}, "restarted after bus-off"},
      {CAN_ERR_ACK, {}, {.no_ack = true}, "no acknowledgement"},
      {CAN_ERR_TX_TIMEOUT, {}, {.transmit_timeout = true}, "transmit timeout"},
      {CAN_ERR_LOSTARB, {7}, {.lost_arbitration = true}, "arbitration lost"},
      {CAN_ERR_TRX, {}, {.transceiver_error = true}, "transceiver error"},
      {CAN_ERR_BUSERROR, {}, {.protocol_error = true}, "protocol error"},
      {CAN_ERR_CNT, {0, 0, 0, 0, 0, 0, 128, 3}, {}, "error of no known class"},
      {CAN_ERR_CRTL, {0, CAN_ERR_CRTL_RX_PASSIVE}, {.error_passive = true}, "error passive"},
      {CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_PASSIVE}, {.error_passive = true}, "error passive"},
      {CAN_ERR_CRTL, {0, CAN_ERR_CRTL_RX_WARNING}, {.error_warning = true}, "error warning"},
      {CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_WARNING}, {.error_warning = true}, "error warning"},
      {CAN_ERR_CRTL, {0, CAN_ERR_CRTL_ACTIVE}, {.error_active = true}, "error active again"},
      {CAN_ERR_CRTL, {0, CAN_ERR_CRTL_RX_OVERFLOW}, {.receive_overflow = true}, "receive overflow in the controller"},
      {CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_OVERFLOW}, {.transmit_overflow = true}, "transmit overflow in the controller"},
      {CAN_ERR_PROT, {0, 0, CAN_ERR_PROT_STUFF, 0}, {.protocol_error = true}, "protocol error"},
      {CAN_ERR_PROT,
       {0, 0, 0, CAN_ERR_PROT_LOC_ACK},
       {.no_ack = true, .protocol_error = true},
       "no acknowledgement, protocol error"},
      {CAN_ERR_CRTL | CAN_ERR_ACK,
       {0, CAN_ERR_CRTL_TX_PASSIVE},
       {.no_ack = true, .error_passive = true},
       "no acknowledgement, error passive"},
      // Data of another class say nothing.
      {CAN_ERR_BUSOFF, {0xFF, 0xFF, 0xFF, CAN_ERR_PROT_LOC_ACK, 0xFF, 0xFF, 0xFF, 0xFF}, {.bus_off = true}, "bus-off"},
  };
  for (const Case& one : cases) {
    EXPECT_EQ(decode_errors(one.classes, one.data), one.expected) << one.words;
    EXPECT_EQ(text(decode_errors(one.classes, one.data)), one.words);
  }
}

TEST(CanError, missing_data_is_no_news) {
  const std::array<Byte, 8> data{0, CAN_ERR_CRTL_TX_PASSIVE};
  EXPECT_EQ(decode_errors(CAN_ERR_CRTL, Bytes(data).first(0)), CanErrors{});
  EXPECT_EQ(decode_errors(CAN_ERR_CRTL, Bytes(data).first(1)), CanErrors{});
  EXPECT_EQ(decode_errors(CAN_ERR_CRTL, Bytes(data).first(2)), CanErrors{.error_passive = true});
}

// --- Filters --------------------------------------------------------------------------------------------------------

CanFrame extended(std::uint32_t id) {
  CanFrame frame;
  frame.extended = true;
  frame.id = id;
  return frame;
}

/// All ids of CANopen nodes 1 to `nodes`.
std::vector<CanFilter> canopen(std::uint32_t nodes) {
  std::vector<CanFilter> filters;
  for (std::uint32_t node = 1; node <= nodes; ++node) {
    for (const std::uint32_t function : {0x080U, 0x180U, 0x280U, 0x380U, 0x480U, 0x580U, 0x700U}) {
      filters.push_back({.id = function + node});
    }
  }
  return filters;
}

bool let_through(const std::vector<CanFilter>& filters, const CanFrame& frame) {
  return std::ranges::any_of(filters, [&](const CanFilter& filter) { return filter.passes(frame); });
}

TEST(FilterSet, passes_what_was_asked_for_and_its_remote_frames_alone) {
  const FilterSet none;
  EXPECT_FALSE(none.passes(data_frame(0, {})) || none.passes(extended(0)));
  EXPECT_TRUE(none.for_kernel().empty());
  const FilterSet nodes(canopen(3));
  EXPECT_TRUE(nodes.passes(data_frame(0x183, {})) && nodes.passes(remote_frame(0x703, 1)));
  EXPECT_FALSE(nodes.passes(data_frame(0x184, {})) || nodes.passes(data_frame(0x603, {})));
  EXPECT_FALSE(nodes.passes(extended(0x183)));
  const FilterSet range({{.id = 0x700, .mask = 0x780}});
  EXPECT_TRUE(range.passes(data_frame(0x77F, {})));
  EXPECT_FALSE(range.passes(data_frame(0x6FF, {})));
  const FilterSet wide({{.id = 0x0601, .mask = kMaxExtendedId, .extended = true}});
  EXPECT_TRUE(wide.passes(extended(0x0601)));
  EXPECT_FALSE(wide.passes(extended(0x10000601)) || wide.passes(data_frame(0x601, {})));
}

TEST(FilterSet, as_many_filters_as_the_kernel_takes_go_to_it_as_they_are) {
  const std::vector<CanFilter> filters = canopen(73);  // 511
  const std::vector<CanFilter> told = FilterSet(filters).for_kernel();
  EXPECT_EQ(told.size(), filters.size());
  for (const CanFilter& filter : told) EXPECT_EQ(filter.mask, kMaxStandardId);
}

TEST(FilterSet, more_are_widened_until_they_are_few_enough_and_lose_nothing) {
  const FilterSet set(canopen(127));
  const std::vector<CanFilter> told = set.for_kernel();
  EXPECT_LE(told.size(), kMaxKernelFilters);
  EXPECT_GT(told.size(), 2) << "no wider than needed";
  for (std::uint32_t id = 0; id <= kMaxStandardId; ++id) {
    const CanFrame frame = data_frame(id, {});
    EXPECT_TRUE(!set.passes(frame) || let_through(told, frame)) << id;
  }
  EXPECT_FALSE(let_through(told, data_frame(0x605, {}))) << "requests of others stay outside";
}

TEST(FilterSet, both_widths_of_id_survive_the_narrowest_limit) {
  std::vector<CanFilter> filters = canopen(10);
  for (std::uint32_t id = 0; id < 20; ++id) {
    filters.push_back({.id = id << 20, .mask = kMaxExtendedId, .extended = true});
  }
  const std::vector<CanFilter> told = FilterSet(filters).for_kernel(2);
  EXPECT_EQ(told.size(), 2);
  for (const CanFilter& filter : filters) {
    CanFrame frame = extended(filter.id);
    frame.extended = filter.extended;
    EXPECT_TRUE(let_through(told, frame));
  }
}

// --- What waits to be sent ------------------------------------------------------------------------------------------

constexpr Instant kStart = Instant{} + 1h;

TEST(SendQueue, keeps_the_order_with_urgent_frames_before_the_others) {
  SendQueue queue;
  for (const auto& [id, urgent] : {std::pair(1U, false), {2U, true}, {3U, false}, {4U, true}}) {
    ASSERT_TRUE(queue.push(data_frame(id, {}), urgent, kStart));
  }
  std::vector<std::uint32_t> ids;
  for (; !queue.empty(); queue.pop()) ids.push_back(queue.front().id);
  EXPECT_THAT(ids, ElementsAre(2, 4, 1, 3));
}

TEST(SendQueue, takes_no_more_than_its_bound) {
  SendQueue queue;
  for (std::size_t i = 0; i < kMaxUnsentFrames; ++i) ASSERT_TRUE(queue.push(data_frame(1, {}), false, kStart));
  EXPECT_FALSE(queue.push(data_frame(2, {}), false, kStart));
  EXPECT_FALSE(queue.push(data_frame(2, {}), true, kStart));
  EXPECT_EQ(queue.size(), kMaxUnsentFrames);
}

TEST(SendQueue, the_frame_that_waits_longest_is_overdue_first_also_behind_urgent_ones) {
  SendQueue queue;
  EXPECT_EQ(queue.overdue_at(), kNever);
  ASSERT_TRUE(queue.push(data_frame(1, {}), false, kStart));
  ASSERT_TRUE(queue.push(data_frame(2, {}), true, kStart + 100ms));
  EXPECT_EQ(queue.overdue_at(), kStart + kMaxSendWait);
  queue.pop();
  EXPECT_EQ(queue.overdue_at(), kStart + kMaxSendWait) << "the urgent one went";
  queue.pop();
  EXPECT_EQ(queue.overdue_at(), kNever);
}

// --- Devices --------------------------------------------------------------------------------------------------------

TEST(CanDevice, is_an_interface_or_the_path_of_a_serial_adapter_with_a_rate_of_its_own) {
  EXPECT_EQ(parse_can_device("can0"), (CanDevice{.lawicel = false, .path = "can0"}));
  EXPECT_EQ(parse_can_device("slcan:/dev/ttyACM0"), (CanDevice{.lawicel = true, .path = "/dev/ttyACM0"}));
  EXPECT_EQ(parse_can_device("slcan:/dev/ttyUSB0@3000000"),
            (CanDevice{.lawicel = true, .path = "/dev/ttyUSB0", .baud = 3000000}));
  for (const std::string path : {"/dev/serial/by-id/usb@x", "/dev/usb@", "/dev/usb@99999999999"}) {
    EXPECT_EQ(parse_can_device("slcan:" + path).path, path) << "an at sign in a path is part of it";
  }
}

TEST(CanDevice, each_mistake_is_named_and_good_ones_have_none) {
  EXPECT_EQ(can_device_mistake("can0", 500000), "");
  EXPECT_EQ(can_device_mistake("fifteen-letters", 33333), "");
  for (const std::uint32_t rate : {10000U, 20000U, 50000U, 100000U, 125000U, 250000U, 500000U, 800000U, 1000000U}) {
    EXPECT_EQ(can_device_mistake("slcan:/dev/ttyACM0", rate), "") << rate;
  }
  const std::tuple<const char*, std::uint32_t, const char*> mistakes[] = {
      {"", 500000, "missing"},
      {"sixteen-letters-", 500000, "15 characters"},
      {"/dev/ttyACM0", 500000, "slcan:PATH"},
      {"can 0", 500000, "no interface name"},
      {"slcan:", 500000, "path"},
      {"slcan:@115200", 500000, "path"},
      {"slcan:/dev/ttyACM0", 333333, "not 333333"},
      {"can0", 0, "no bit rate"},
      {"can0", 1000001, "no bit rate"},
  };
  for (const auto& [device, rate, words] : mistakes) {
    EXPECT_THAT(can_device_mistake(device, rate), HasSubstr(words)) << device << " " << rate;
  }
}

TEST(FrameAge, is_the_time_since_the_stamp_and_a_jump_of_the_wall_clock_is_none) {
  EXPECT_EQ(frame_age(1000s + 3ms, 1000s), 3ms);
  EXPECT_EQ(frame_age(1000s, 1000s), 0ms);
  EXPECT_EQ(frame_age(5000s, 1000s), 100ms);
  EXPECT_EQ(frame_age(1000s, 5000s), 0ms);
}

TEST(InterfaceTrouble, says_what_to_do) {
  EXPECT_EQ(interface_trouble("can0", 500000, ENETDOWN), "can0 is down: ip link set can0 up type can bitrate 500000");
  EXPECT_THAT(interface_trouble("can0", 500000, ENODEV), HasSubstr("can0 does not exist"));
  EXPECT_THAT(interface_trouble("eth0", 500000, EAFNOSUPPORT), HasSubstr("eth0 is no CAN interface"));
  EXPECT_THAT(interface_trouble("can0", 500000, EPERM), HasSubstr("can0: not allowed"));
}

}  // namespace
}  // namespace axisgate::can
