// SPDX-License-Identifier: Apache-2.0
// What people's tools make of the answers that they get: the scans, the tables of `top`, the line of `move` and `jog`;
// and what a CAN controller tells of errors.
#include "adapters/can/can_error.hpp"
#include "gateway/commands/scan/plan/scan_table.hpp"
#include "gateway/commands/scan/plan/serial_scan_plan.hpp"
#include "gateway/commands/view/manual_view.hpp"
#include "gateway/profile/read/profile_loader.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/places.hpp"

namespace axisgate::fuzz {
namespace {

constexpr int kMostSteps = 100'000;  // more than any scan of a few nodes takes

const std::vector<profile::Profile>& profiles() {
  static const std::vector<profile::Profile> kProfiles = [] {
    std::vector<profile::Profile> made;
    for (const char* name : {"kinco-jd", "leadshine-ld2-can", "id286pro"})
      made.push_back(profile::load_profile(test::source_path("schemas/drives/") + name + ".json").profile);
    return made;
  }();
  return kProfiles;
}

bool is_shown(char letter, bool lines) { return (lines && letter == '\n') || (letter >= ' ' && letter != '\x7F'); }

void must_be_shown(const std::string& text, bool lines) {
  for (const char letter : text)
    must(is_shown(letter, lines) || static_cast<unsigned char>(letter) >= 0x80,
         "no control character reaches a terminal");
}

/// Of a read: whatever the far end may say.
bus::ExchangeResult any_result(Input& input, const bus::Exchange& asked) {
  bus::ExchangeResult result;
  static constexpr std::array kSizes{std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{4}};
  switch (input.below(5)) {
    case 0:
      result.code = Errc::timed_out;
      break;
    case 1:
      result.code = Errc::refused_by_drive;
      result.detail = input.number();
      result.for_now = input.yes();
      break;
    case 2: {
      const Bytes bytes = input.bytes(input.below(80));
      result.bytes = std::make_shared<const std::vector<Byte>>(bytes.begin(), bytes.end());
      break;
    }
    case 3:
      result.more = input.yes();
      break;
    default:
      result.fields.push_back({asked.object, kSizes[input.below(3)], input.number()});
      break;
  }
  return result;
}

template <typename Plan>
void must_end(Plan& plan) {
  for (int steps = 0; plan.next(); ++steps) {
    must(steps < kMostSteps, "where nobody answers a scan ends");
    plan.on_result({.code = Errc::timed_out});
  }
}

void scan(Input input) {
  commands::ScanPlan plan(profiles(), {1, 4});
  for (auto asked = plan.next(); input.more() && asked; asked = plan.next()) {
    must(asked->access == bus::Access::read, "a scan only reads");
    must(asked->node >= 1 && asked->node <= 4, "a scan asks those it was told to");
    if (input.below(8) == 0) {
      bus::UnsolicitedEvent event;
      event.kind = static_cast<bus::UnsolicitedEvent::Kind>(input.below(7));
      event.node = input.byte();
      event.state = static_cast<bus::NodeState>(input.below(4));
      plan.heard(event);
    } else {
      plan.on_result(any_result(input, *asked));
    }
  }
  must_end(plan);
  for (const commands::FoundNode& node : plan.found()) must_be_shown(node.name, false);
  must_be_shown(commands::scan_table(plan.found()), true);
}

void serial_scan(Input input) {
  commands::SerialScanPlan plan(profiles(), {.bauds = {38400, 9600}, .stations = {1, 3}});
  for (int steps = 0; plan.speech(); ++steps) {
    must(steps < kMostSteps, "a scan ends");
    const auto asked = plan.next();
    if (!asked) continue;
    must(asked->access == bus::Access::read, "a scan only reads");
    must(asked->node >= 1 && asked->node <= 3, "a scan asks those it was told to");
    plan.on_result(input.more() ? any_result(input, *asked) : bus::ExchangeResult{.code = Errc::timed_out});
  }
  must_be_shown(commands::serial_scan_table(plan.found(), "/dev/lift"), true);
}

void hand_replies(Input input) {
  const commands::ManualListener listener{.order = static_cast<commands::WordOrder>(input.below(3)),
                                          .float_numbers = input.yes()};
  while (input.more()) {
    const Bytes reply = input.bytes(input.word() % 260);
    must_be_shown(commands::exception_text(commands::exception_in(reply)), false);
    must(commands::identification_in(reply).size() <= reply.size(), "an object is part of its reply");
    const auto registers = commands::registers_in(reply, commands::kManualRegisters);
    must(!registers || registers->size() == commands::kManualRegisters, "as many registers as were asked for");
    const auto inputs = commands::inputs_in(reply, 13);
    if (!registers) continue;
    const commands::ManualView view = commands::manual_view(*registers, inputs.value_or(input.word()), listener);
    must_be_shown(commands::manual_line(1, view, "moves"), false);
    must_be_shown(commands::owner_text(view), false);
  }
}

void top_table(Input input) {
  commands::TopReading reading;
  reading.server = "127.0.0.1:1502";
  reading.float_numbers = input.yes();
  const std::size_t columns = input.byte();
  for (auto& each : reading.gateway) each = input.word();
  while (input.more() && reading.axes.size() < 4) {
    commands::AxisReading axis{.axis = static_cast<AxisNumber>(1 + input.word() % 499)};
    for (auto& each : axis.registers) each = input.word();
    if (input.yes()) commands::mark_out_of_reach(axis);
    reading.axes.push_back(axis);
  }
  static_cast<void>(commands::word_order(reading.gateway));
  must_be_shown(commands::text_of(commands::table_lines(reading, columns)), true);
}

void can_errors(Input input) {
  while (input.more()) {
    const std::uint32_t classes = input.number();
    const can::CanErrors errors = can::decode_errors(classes, input.bytes(input.below(9)));
    must(!can::text(errors).empty(), "each has its words");
    must((classes & can::error_class::kBusOff) == 0 || errors.bus_off, "a bus-off is never overlooked");
  }
}

}  // namespace
}  // namespace axisgate::fuzz

using axisgate::fuzz::Input;

int axisgate_fuzz_scan(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::scan(Input(data, size));
  return 0;
}
int axisgate_fuzz_serial_scan(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::serial_scan(Input(data, size));
  return 0;
}
int axisgate_fuzz_hand_replies(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::hand_replies(Input(data, size));
  return 0;
}
int axisgate_fuzz_top_table(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::top_table(Input(data, size));
  return 0;
}
int axisgate_fuzz_can_errors(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::can_errors(Input(data, size));
  return 0;
}
