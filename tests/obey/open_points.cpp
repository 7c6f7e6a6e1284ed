// SPDX-License-Identifier: Apache-2.0
#include "tests/obey/open_points.hpp"

#include "gateway/core/random.hpp"

namespace axisgate::test::obey {
namespace {

Duration reply_delay(Random& random) { return std::chrono::microseconds(100 + random.below(5000)); }

void draw(simulated::Id286proOptions& options, Random& random) {
  options.speed_follows_register = random.chance(1, 2);
  options.command_reads_back = random.chance(1, 2);
  options.refuses_what_cannot_act = random.chance(1, 2);
  if (random.chance(1, 4)) options.most_registers = 2;
}

void draw(simulated::KincoRtuDrive& drive, Random& random) {
  drive.rtu.read_error_function = random.chance(1, 2) ? 0x81 : 0x83;
  drive.rtu.answer_delay = reply_delay(random);
}

void draw(simulated::LeadshineOptions& options, Random& random) {
  options.acknowledges_setpoints = random.chance(1, 2);
  options.ready_flag = random.chance(1, 2);
  options.needs_halt_edge = random.chance(1, 2);
  options.mode = random.chance(1, 2) ? 8 : 0;
  options.sends_emergencies = random.chance(1, 2);
  options.leaves_operational_on_loss = random.chance(1, 2);
  options.event_timer = random.chance(1, 2);
  if (random.chance(1, 4)) options.unmappable = {{0x606C, 0}, {0x6077, 0}};
  constexpr std::array<Duration, 3> kFalls{Duration{}, std::chrono::milliseconds(20), std::chrono::milliseconds(200)};
  options.reached_falls = kFalls[static_cast<std::size_t>(random.below(kFalls.size()))];
}

void draw(simulated::KincoCanDrive& drive, Random& random) {
  drive.can.echoes_written = random.chance(1, 2);
  drive.can.short_frames = random.chance(1, 2);
  drive.can.stops_without_master = random.chance(1, 2);
  // JD 2.3: 0006h "after CAN start-up". Whether one that stays enabled without its master wants it anew is not said; it
  // would hear no quick stop then.
  drive.can.first_word_needed = drive.can.stops_without_master;
  if (random.chance(1, 4)) drive.can.unmappable = {{0x606C, 0}, {0x6078, 0}};
}

/// Its sheet leaves nothing open, or what is known of it is a public file.
template <typename Drive>
void draw(Drive& /*drive*/, Random& /*random*/) {}

}  // namespace

void draw_open_points(GatewayStage::Line& line, std::uint64_t number) {
  const auto each = [number](auto& drives) {
    for (auto& staged : drives) {
      Random random(number);
      std::visit([&](auto& options) { draw(options, random); }, staged.options);
    }
  };
  each(line.rtu_drives);
  each(line.can_drives);
  Random random(number);
  line.options.reply_delay = reply_delay(random);
  if (random.chance(1, 2)) line.options.baud = 38400;
  if (line.can_drives.empty()) return;
  constexpr std::array<std::uint32_t, 3> kBitRates{125'000, 500'000, 1'000'000};
  line.can_options.bit_rate = kBitRates[static_cast<std::size_t>(random.below(kBitRates.size()))];
  line.can_options.reply_delay = reply_delay(random);
}

}  // namespace axisgate::test::obey
