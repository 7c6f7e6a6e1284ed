// SPDX-License-Identifier: Apache-2.0
// The rules of wire.hpp, asked of the wire of each protocol: one reply to each request, none that belongs to another,
// none after abandon() or a loss of the link; and of the lines that can babble, what becomes of one that does.
#include "adapters/canopen/canopen_wire.hpp"
#include "adapters/keya/keya_can_codec.hpp"
#include "adapters/keya/keya_can_wire.hpp"
#include "adapters/keya/keya_serial_wire.hpp"
#include "adapters/kinco/kinco_wire.hpp"
#include "adapters/modbus_rtu/rtu_wire.hpp"
#include "tests/unit/bus/scripted_links.hpp"

namespace axisgate::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// The far end of a wire.
struct FarEnd {
  std::function<void(std::string_view hex)> bring;
  std::function<void()> up;
  std::function<void(std::string_view why)> down;
  std::function<void()> make_noise;  ///< two bytes that are no frame; none: this line cannot babble
  std::vector<std::string>* reopened = nullptr;
  std::vector<std::string>* sent = nullptr;
};

struct Made {
  std::unique_ptr<bus::Wire> wire;
  FarEnd far;
};

struct Protocol {
  const char* name;
  ObjectAddress first, second;  ///< of two reads to node 1; of different length where the answers say no more
  std::uint8_t second_size;
  const char* first_answer;
  const char* second_answer;
  Made (*make)(Runtime&, const Log&);
};
void PrintTo(const Protocol& protocol, std::ostream* out) { *out << protocol.name; }

template <typename Link>
FarEnd far_end_of(Link* link) {
  FarEnd far;
  far.up = [link] { link->events->on_link_up(); };
  far.down = [link](std::string_view why) { link->events->on_link_down(why); };
  if constexpr (!std::is_same_v<Link, ScriptedCanLink>) {
    far.bring = [link](std::string_view hex) { link->bring(hex); };
    far.reopened = &link->reopened;
    far.sent = &link->sent;
  }
  if constexpr (std::is_same_v<Link, ScriptedLink>) far.make_noise = [link] { link->bring("55 01"); };
  if constexpr (std::is_same_v<Link, ScriptedRtuLink>) {
    far.make_noise = [link] { link->events->on_bad_frame(link->newest, 2); };
  }
  return far;
}

Made kinco_wire(Runtime& runtime, const Log& log) {
  auto link = std::make_unique<ScriptedLink>();
  const FarEnd far = far_end_of(link.get());
  return {std::make_unique<kinco::KincoWire>("lift", std::move(link), runtime, log), far};
}
template <keya::KeyaLine line>
Made keya_wire(Runtime& runtime, const Log& log) {
  auto link = std::make_unique<ScriptedLink>();
  const FarEnd far = far_end_of(link.get());
  return {keya::make_keya_serial_wire({.name = "lift", .line = line}, std::move(link), runtime, log), far};
}
Made rtu_wire(Runtime& runtime, const Log& log) {
  auto link = std::make_unique<ScriptedRtuLink>();
  const FarEnd far = far_end_of(link.get());
  return {std::make_unique<modbus_rtu::RtuWire>("lift", std::vector{modbus_rtu::RtuNode{}}, modbus_rtu::LineSpeed{},
                                                std::move(link), runtime, log),
          far};
}
Made canopen_wire(Runtime& runtime, const Log& log) {
  auto link = std::make_unique<ScriptedCanLink>();
  FarEnd far = far_end_of(link.get());
  far.bring = [to = link.get(), &runtime](std::string_view hex) {
    to->events->on_frame(can::data_frame(0x581, from_hex(hex)), runtime.now());
  };
  return {canopen::make_canopen_wire({.name = "lift", .nodes = {{.node = 1}}}, std::move(link), runtime, log), far};
}
Made keya_can_wire(Runtime& runtime, const Log& log) {
  auto link = std::make_unique<ScriptedCanLink>();
  FarEnd far = far_end_of(link.get());
  far.bring = [to = link.get(), &runtime](std::string_view hex) {
    to->events->on_frame(keya::extended_frame(0x05800001, from_hex(hex)), runtime.now());
  };
  return {keya::make_keya_can_wire({.name = "lift", .nodes = {1}}, std::move(link), runtime, log), far};
}

const Protocol kProtocols[] = {
    {"kinco",
     {0x6041, 0},
     {0x6063, 0},
     4,
     "01 4B 41 60 00 37 C0 00 00 1C",
     "01 43 63 60 00 B0 3C FF FF 0F",
     kinco_wire},
    {"keya_rs232",
     {0x2102, 0},
     {0x2105, 0},
     1,
     "ED 02 01 F5 FE 0E 00 00 00 00 00 00",
     "ED 05 31 00 00 00 00 00 00 00 00 00",
     keya_wire<keya::KeyaLine::rs232>},
    {"keya_rs485",
     {0x2102, 0},
     {0x2105, 0},
     1,
     "ED 01 02 01 F5 FE 0E 00 00 00 00 F2",
     "ED 01 05 31 00 00 00 00 00 00 00 24",
     keya_wire<keya::KeyaLine::rs485>},
    {"modbus_rtu", {0x3200, 0}, {0x3700, 0}, 4, "01 03 02 C0 37", "01 03 04 C3 50 00 00", rtu_wire},
    {"canopen", {0x6041, 0}, {0x6063, 0}, 4, "4B 41 60 00 37 02 00 00", "43 63 60 00 B0 3C FF FF", canopen_wire},
    {"keya_can", {0x2103, 1}, {0x2112, 1}, 4, "60 03 21 01 01 F5 FE 0E", "60 12 21 01 08 11 00 11", keya_can_wire},
};

class WireRules : public WireStage, public testing::WithParamInterface<Protocol> {
 protected:
  WireRules() {
    Made made = GetParam().make(runtime, log);
    wire = std::move(made.wire);
    far = made.far;
    wire->start(*this);
    far.up();
    forget();
  }
  static bus::Exchange first() { return {.node = 1, .object = GetParam().first, .size = 2}; }
  static bus::Exchange second() { return {.node = 1, .object = GetParam().second, .size = GetParam().second_size}; }
  void answer_first() { far.bring(GetParam().first_answer); }
  void answer_second() { far.bring(GetParam().second_answer); }
  [[nodiscard]] std::uint32_t late() const { return wire->statistics().late_replies; }
  /// What was asked for, in order of the replies.
  [[nodiscard]] std::vector<ObjectAddress> answered() const {
    std::vector<ObjectAddress> objects;
    for (const bus::ExchangeResult& result : replies) {
      EXPECT_EQ(result.code, Errc::ok);
      objects.push_back(result.fields.at(0).object);
    }
    return objects;
  }
  FarEnd far;
};

TEST_P(WireRules, one_reply_to_each_request_and_a_second_one_is_counted_and_not_told) {
  wire->send(first());
  answer_first();
  answer_first();
  EXPECT_THAT(answered(), ElementsAre(GetParam().first));
  EXPECT_EQ(late(), 1u);
}

TEST_P(WireRules, no_reply_after_abandon_and_a_late_one_does_not_answer_the_next_request) {
  wire->send(first());
  wire->abandon();
  answer_first();
  EXPECT_THAT(told, IsEmpty());
  EXPECT_EQ(late(), 1u);
  wire->send(first());
  wire->abandon();
  wire->send(second());
  answer_first();
  EXPECT_THAT(replies, IsEmpty());
  EXPECT_EQ(late(), 2u);
  answer_second();
  EXPECT_THAT(answered(), ElementsAre(GetParam().second));
}

TEST_P(WireRules, the_next_request_may_be_sent_from_inside_a_reply) {
  wire->send(first());
  next = second();
  answer_first();
  answer_second();
  EXPECT_THAT(answered(), ElementsAre(GetParam().first, GetParam().second));
  EXPECT_EQ(late(), 0u);
}

TEST_P(WireRules, a_lost_link_is_told_once_takes_the_awaited_answer_along_and_its_return_is_counted) {
  wire->send(first());
  far.down("/dev/ttyUSB0: hung up");
  far.down("still");
  far.up();
  answer_first();
  EXPECT_THAT(told, ElementsAre("down: /dev/ttyUSB0: hung up", "up"));
  EXPECT_EQ(wire->statistics().reconnects, 1u);
}

TEST_P(WireRules, destroyed_with_an_exchange_outstanding_it_calls_nobody) {
  wire->send(first());
  wire.reset();
  runtime.advance_by(1h);
  EXPECT_THAT(told, IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Each, WireRules, testing::ValuesIn(kProtocols),
                         [](const auto& of) { return std::string(of.param.name); });

// --- Lines of bytes -------------------------------------------------------------------------------------------------

class ByteLineRules : public WireRules {
 protected:
  /// Noise in each millisecond.
  void babble(Duration how_long) {
    for (const Instant end = runtime.now() + how_long; runtime.now() < end; runtime.advance_by(1ms)) far.make_noise();
  }
  void give_up() {
    babble(500ms);
    forget();
  }
  void expect_service() {
    replies.clear();
    wire->send(first());
    answer_first();
    EXPECT_EQ(replies.size(), 1u);
  }
};

TEST_P(ByteLineRules, what_came_with_an_answer_cannot_answer_what_is_sent_next) {
  if (GetParam().make == rtu_wire) return;  // its link hands over frames, with the number of what was sent before them
  wire->send(first());
  next = first();
  far.bring(std::string(GetParam().first_answer) + " " + GetParam().first_answer);
  EXPECT_EQ(replies.size(), 1u) << "the second came before its request was sent";
  EXPECT_EQ(late(), 1u);
  answer_first();
  EXPECT_EQ(replies.size(), 2u);
}

TEST_P(ByteLineRules, a_burst_of_noise_is_one_bad_frame_and_keeps_no_answer_away) {
  wire->send(first());
  babble(50ms);
  answer_first();
  EXPECT_THAT(told, ElementsAre("reply"));
  EXPECT_THAT(*far.reopened, IsEmpty());
  EXPECT_EQ(wire->statistics().dropped_bytes, 100u);
  EXPECT_EQ(wire->statistics().bad_frames, 1u);
}

TEST_P(ByteLineRules, a_line_that_babbles_is_opened_anew_three_times_and_then_given_up_with_what_was_asked) {
  wire->send(first());
  babble(150ms);
  EXPECT_THAT(told, ElementsAre(HasSubstr("down: noise without a pause"), "up"));
  EXPECT_THAT(*far.reopened, ElementsAre(HasSubstr("noise without a pause")));
  babble(2s);
  EXPECT_THAT(told, ElementsAre(HasSubstr("down"), "up", HasSubstr("down"), "up", HasSubstr("down"), "up",
                                HasSubstr("opened anew 3 times, waiting for silence")));
  answer_first();
  EXPECT_THAT(replies, IsEmpty());
}

TEST_P(ByteLineRules, a_line_given_up_is_opened_anew_each_second_and_taken_back_within_a_second_of_silence) {
  give_up();
  const std::size_t before = far.reopened->size();
  babble(5s);
  EXPECT_EQ(far.reopened->size(), before + 5);
  EXPECT_THAT(told, IsEmpty()) << "the bus hears of it once";
  runtime.advance_by(1s);
  EXPECT_THAT(told, ElementsAre("up"));
  expect_service();
}

TEST_P(ByteLineRules, whole_frames_of_others_are_no_noise) {
  for (int i = 0; i < 1000; ++i, runtime.advance_by(1ms)) answer_first();
  EXPECT_THAT(*far.reopened, IsEmpty());
  EXPECT_THAT(told, IsEmpty());
  EXPECT_EQ(late(), 1000u);
}

TEST_P(ByteLineRules, up_to_eight_bytes_of_a_glitch_before_an_answer_are_skipped_and_counted_as_bytes_alone) {
  if (GetParam().make == rtu_wire) return;  // its link finds frames
  std::uint32_t bytes = 0;
  for (const char* glitch : {"00", "FF", "00 FF 00", "FF FF FF FF FF FF FF FF"}) {
    for (const bool glued : {true, false}) {
      forget();
      wire->send(first());
      if (!glued) far.bring(glitch);
      runtime.advance_by(25ms);
      far.bring((glued ? std::string(glitch) + " " : "") + GetParam().first_answer);
      EXPECT_THAT(answered(), ElementsAre(GetParam().first)) << glitch;
      bytes += static_cast<std::uint32_t>(from_hex(glitch).size());
    }
  }
  EXPECT_EQ(wire->statistics().dropped_bytes, bytes);
  EXPECT_EQ(wire->statistics().bad_frames, 0u);
}

TEST_P(ByteLineRules, a_line_that_echoes_is_answered_its_copies_counted_and_told_once) {
  for (int i = 0; i < 10; ++i) {
    wire->send(second());  // of Keya one that no drive answers with zeros
    far.bring(far.sent->back());
    runtime.advance_by(50ms);
    answer_second();
    runtime.advance_by(1s);
  }
  EXPECT_THAT(replies, SizeIs(10));
  EXPECT_EQ(wire->statistics().echoes, 10u);
  EXPECT_EQ(wire->statistics().bad_frames + wire->statistics().late_replies + wire->statistics().dropped_bytes, 0u);
  EXPECT_THAT(log_lines, ElementsAre(HasSubstr("the line echoes")));
}

TEST_P(ByteLineRules, where_only_copies_come_the_log_says_so_once_a_minute) {
  for (int i = 0; i < 50; ++i) {
    wire->send(second());
    far.bring(far.sent->back());
    runtime.advance_by(1s);
    wire->abandon();
  }
  EXPECT_THAT(replies, IsEmpty());
  EXPECT_EQ(wire->statistics().echoes, 50u);
  EXPECT_EQ(
      std::ranges::count_if(
          log_lines,
          [](const std::string& line) {
            return line.find("only copies of our own requests come: the adapter hears itself, or the line is looped") !=
                   std::string::npos;
          }),
      1);
}

TEST_P(ByteLineRules, a_whole_frame_that_does_not_fit_is_told_with_what_was_asked_and_what_came) {
  wire->send(second());
  answer_first();
  EXPECT_THAT(log_lines, ElementsAre(testing::AllOf(HasSubstr("a valid frame that does not fit: asked was \""),
                                                    HasSubstr("\", what came is \""))));
  wire->abandon();
  wire->send(first());
  answer_second();
  EXPECT_THAT(log_lines, SizeIs(1)) << "an answer that is only late is none";
}

INSTANTIATE_TEST_SUITE_P(Each, ByteLineRules, testing::ValuesIn(std::vector(kProtocols, kProtocols + 4)),
                         [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace axisgate::test
