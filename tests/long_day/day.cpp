// SPDX-License-Identifier: Apache-2.0
#include "tests/long_day/day.hpp"

#include <malloc.h>

#include <stdexcept>

namespace axisgate::test::long_day {
namespace {

using namespace std::chrono_literals;

constexpr AxisNumber kAxesOfAClient = 3;
constexpr Duration kBetweenRequests = 100ms;
constexpr std::uint64_t kShareOfFault = 3;  // of its time at most one part in so many
constexpr Duration kQuiet = 40s;  // a drive that was lost for long is probed each 20 s at least (200 timeouts)

}  // namespace

Day::Day(std::uint64_t seed) : stage_(plant(), seed), faults_(stage_, plant(), seed), random_(seed) {
  for (AxisNumber first = 1; first <= kAxes; first = static_cast<AxisNumber>(first + kAxesOfAClient)) {
    std::vector<AxisNumber> axes;
    for (AxisNumber axis = first; axis < first + kAxesOfAClient; ++axis) axes.push_back(axis);
    clients_.push_back(
        std::make_unique<DayClient>(context_, stage_.runtime(), static_cast<std::uint8_t>(first), axes, seed + first));
  }
}

/// Clients ask, and now and then one goes.
void Day::live(Duration time, bool ask) {
  constexpr double kGoes = 0.002;
  for (Duration gone{}; gone < time; gone += kBetweenRequests) {
    for (const auto& client : clients_) {
      if (ask) client->turn();
      if (ask && random_.chance(kGoes)) client->leave();
      if (!client->wrong().empty()) left_.wrong = client->wrong();
    }
    stage_.run(kBetweenRequests);
    look_at_motors();
  }
  forget_what_tests_keep();
}

void Day::look_at_motors() {
  for (AxisNumber axis = 1; axis <= kAxes; ++axis) {
    const Sample& position = stage_.axis(axis)[Quantity::position_actual];
    if (!position.valid) continue;
    if (position.value != seen_at_[axis]) ++moves_[axis];
    seen_at_[axis] = position.value;
  }
}

/// The stage keeps all that was sent and logged, for other tests.
void Day::forget_what_tests_keep() {
  for (std::size_t line = 0; line < stage_.gateway().bus_count(); ++line) {
    stage_.at_link(line, [](auto& link) {
      link.sent.clear();
      if constexpr (requires { link.received; }) link.received.clear();
    });
  }
  left_.log_lines += stage_.log().size();
  stage_.log().clear();
}

void Day::tell_lines() {
  for (std::size_t line = 0; line < stage_.gateway().bus_count(); ++line) {
    const bus::Bus& bus = stage_.gateway().bus(line);
    const bus::Statistics counted = bus.statistics();
    left_.lines.push_back({counted.requests, counted.replies, counted.requests - counted.replies - counted.timeouts,
                           1 + faults_.endings_on(line), bus.queue_depth()});
  }
}

DayLeft Day::pass(std::uint64_t faults, std::chrono::milliseconds each,
                  const std::function<void(const std::string&)>& tell) {
  if (!stage_.come_online()) throw std::runtime_error("the plant never came online");
  constexpr std::chrono::milliseconds kHour = 1h;
  const auto longest = static_cast<std::uint64_t>(each.count()) / kShareOfFault;
  for (std::uint64_t fault = 0; fault < faults; ++fault) {
    const auto lasts = std::chrono::milliseconds(500 + random_.below(longest));
    faults_.begin();
    live(lasts);
    faults_.end();
    live(each - lasts);
    if (fault == faults / 3) left_.allocated_at_first = mallinfo2().uordblks;
    const std::chrono::milliseconds passed = (fault + 1) * each;
    if (passed % kHour == 0ms)
      tell(std::to_string(passed / kHour) + " h: allocated " + std::to_string(mallinfo2().uordblks) +
           "; faults:" + faults_.told());
  }
  live(kQuiet);
  live(3s, false);  // leases end
  left_.allocated = mallinfo2().uordblks;
  tell_lines();
  for (AxisNumber axis = 1; axis <= kAxes; ++axis) {
    if (stage_.axis(axis).link_state != LinkState::online) left_.not_online.push_back(axis);
    if (moves_[axis] == 0) left_.never_moved.push_back(axis);
  }
  for (const auto& client : clients_) {
    left_.waiting += client->waits() ? 1U : 0U;
    left_.asked.requests += client->asked().requests;
    left_.asked.answers += client->asked().answers;
    left_.asked.exceptions += client->asked().exceptions;
    left_.asked.lost += client->asked().lost;
  }
  left_.events = stage_.gateway().events().events().size();
  left_.faults = faults_.told();
  return left_;
}

}  // namespace axisgate::test::long_day
