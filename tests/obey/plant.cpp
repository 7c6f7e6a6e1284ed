// SPDX-License-Identifier: Apache-2.0
#include "tests/obey/plant.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "tests/obey/open_points.hpp"

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t kProfileVelocity = 600'000, kRamp = 30'000;  // 600 rpm; 3000 rpm/s

void expect(bool what, const std::string& why) {
  if (!what) throw std::runtime_error(why);
}

std::vector<GatewayStage::Line> one_line(Subject subject, const PlantOptions& options) {
  std::vector<GatewayStage::Line> lines;
  lines.push_back(line_with(subject, options.lease, options.neighbour));
  lines.back().last_first = options.neighbour_first;
  if (options.open_points) draw_open_points(lines.back(), *options.open_points);
  if (options.velocity_limit) {
    GatewayStage::Line& line = lines.back();
    for (auto& staged : line.drives) staged.axis.limits.velocity = options.velocity_limit;
    for (auto& staged : line.rtu_drives) staged.axis.limits.velocity = options.velocity_limit;
    for (auto& staged : line.can_drives) staged.axis.limits.velocity = options.velocity_limit;
    for (auto& staged : line.keya_drives) staged.axis.limits.velocity = options.velocity_limit;
  }
  if (options.other_bus) {
    lines.push_back(line_of(simulated::KincoType::jd, kAxisOfOtherBus));
    lines.back().name = "other";
  }
  return lines;
}

}  // namespace

modbus_tcp::ListenerSettings plain(modbus_tcp::ListenerSettings listener) {
  listener.float_numbers = listener.staged_halves = listener.posted_writes = listener.offline_reads_fail = false;
  listener.idle_timeout = Duration{};
  return listener;
}

Plant::Plant(Subject which, PlantOptions options)
    : subject(which),
      stage(one_line(which, options), options.seed),
      listener(std::move(options.listener)),
      log_([this](LogLevel level, std::string_view source, std::string_view message) {
        stage.log().push_back(std::string(axisgate::text(level)) + " " + std::string(source) + ": " +
                              std::string(message));
      }),
      neighbour_(options.neighbour && may_have_neighbour(which)),
      makers_speed_(options.velocity_limit.has_value()),
      power_back_(stage.runtime().make_timer([this] { restart_drive(); })),
      fitter_(port_, stage.runtime(), kHostOfFitter, plain(listener)),
      a(port_, stage.runtime(), kHostOfA),
      b(port_, stage.runtime(), kHostOfB) {
  listener.idle_timeout = Duration{};  // tests that wait for a minute keep their connections
  open_port();
  for (Client* client : {&fitter_, &a, &b}) client->connect();
}

void Plant::ready_but_disabled() {
  expect(stage.come_online(), "the axis never came online");
  for (const auto& [offset, value] : profile_rows()) {
    const Answer answer = fitter_.row(offset, value);
    expect(answer.ok(), "row " + std::to_string(offset) + " was refused: " + std::to_string(answer.exception));
  }
  fitter_.command(kRelease);
  run(100ms);
}

void Plant::ready() {
  ready_but_disabled();
  expect(fitter_.command(kEnable).ok(), "the axis could not be enabled");
  fitter_.command(kRelease);
  run(100ms);
}

void Plant::scan(Client& client, const Write& request, Duration time) {
  for (const Instant end = stage.runtime().now() + time; stage.runtime().now() < end;) {
    client.write(request);
    run(50ms);
  }
}

Rows Plant::profile_rows() {
  constexpr unsigned kBitOfProfileVelocity = 20, kBitOfAcceleration = 21, kBitOfDeceleration = 22;
  Rows rows;
  if (has(kBitOfProfileVelocity) && !makers_speed_) rows[row::profile_velocity] = kProfileVelocity;
  if (has(kBitOfAcceleration)) rows[row::profile_acceleration] = kRamp;
  if (has(kBitOfDeceleration)) rows[row::profile_deceleration] = kRamp;
  return rows;
}

Rows Plant::endless_target() const {
  if (has_speeds(subject)) return {{row::target_velocity, kSpeed}};
  return {{row::target_position, kEndless}};
}

Answer Plant::set_endless(Client& client) {
  const Rows target = endless_target();
  return client.row(target.begin()->first, target.begin()->second);
}

bool Plant::start_endless(Client& client) {
  return set_endless(client).ok() && client.command(endless_command()).ok() && turns_within(std::chrono::seconds(1));
}

bool Plant::enabled() {
  constexpr std::uint16_t kEnabled = 0x27, kStateBits = 0x6F;
  return motor().enabled.value_or((fitter_.word(shown::statusword) & kStateBits) == kEnabled);
}

bool Plant::turns_within(Duration limit) {
  return stage.run_until([&] { return velocity() != 0; }, limit);
}

bool Plant::keeps_turning() {
  if (!turns_within(1s)) return false;
  run(1s);
  return velocity() != 0;
}

bool Plant::comes_to_stand(Duration limit) {
  for (const Instant end = stage.runtime().now() + limit; stage.runtime().now() < end; run(5ms))
    if (stands()) return true;
  return false;
}

bool Plant::stands() {
  for (int i = 0; i < 10; ++i) {
    if (velocity() != 0) return false;
    run(10ms);
  }
  return velocity() == 0;
}

std::int64_t Plant::comes_to_rest_at(Duration limit) {
  run(200ms);  // a start takes its time on a slow line
  if (!stage.run_until([&] { return velocity() == 0; }, limit))
    throw std::runtime_error("the motor never came to rest");
  run(200ms);
  return position();
}

bool Plant::reaches(std::int64_t wanted, Duration limit) {
  return stage.run_until(
      [&] { return std::abs(velocity() - wanted) <= std::max(std::abs(wanted) / 50, std::int64_t{0}); }, limit);
}

bool Plant::logged(const std::string& part) {
  return std::ranges::any_of(stage.log(), [&](const std::string& line) { return line.find(part) != line.npos; });
}

}  // namespace axisgate::test::obey
