// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/web_process/told.hpp"

#include "gateway/upstream/web_process/api/axis_json.hpp"
#include "gateway/upstream/web_process/api/blocked_by.hpp"

namespace axisgate::web {
namespace {

AxisInfoRecord info(std::uint16_t axis, const std::string& name) {
  AxisInfoRecord out;
  out.axis = axis;
  out.name = name;
  out.drive = "Kinco JD";
  out.profile = "kinco-jd";
  out.node = axis;
  out.rated_speed = 3'000'000;
  out.supported_modes = 0b101;
  out.writable = bit(Quantity::target_velocity) | bit(Quantity::mode);
  out.supported_commands = 0b1111110;
  out.limits = {{static_cast<std::uint8_t>(Quantity::target_velocity), -3'000'000, 3'000'000}};
  return out;
}

}  // namespace

std::uint16_t bits_of(std::initializer_list<AxisInput> inputs) {
  std::uint16_t out = 0;
  for (const AxisInput input : inputs) out |= bit(input);
  return out;
}

void set(AxisSample& sample, Quantity quantity, std::int32_t value, std::uint32_t age_us) {
  sample.values.push_back({static_cast<std::uint8_t>(quantity), value, age_us});
}

AxisSample standing(std::uint16_t axis) {
  AxisSample out;
  out.axis = axis;
  out.sequence = 7;
  out.link_state = static_cast<std::uint8_t>(LinkState::online);
  out.axis_state = static_cast<std::uint8_t>(AxisState::standstill);
  out.supported = out.valid = 0xFFFFFFFFU & ~bit(Quantity::motor_temperature);
  out.inputs = bits_of({AxisInput::online, AxisInput::enabled});
  out.loss_stop_ms = 500;
  out.age_ms = 12;
  out.lease_ms = out.result_age_ms = UINT32_MAX;
  set(out, Quantity::mode_display, 3);
  set(out, Quantity::position_actual, 15000);
  set(out, Quantity::velocity_actual, 0);
  set(out, Quantity::error_code, 0);
  set(out, Quantity::vendor_error, 0);
  return out;
}

StatisticsRecord statistics() {
  StatisticsRecord out;
  out.at = kStarted;
  out.state = 1;
  out.axes_online = 2;
  out.worst_turn_us = 1500;
  out.programs = {{"axisgate-dds", true, 2}};
  out.buses.resize(1);
  out.buses[0].link = 1;
  out.buses[0].load_permille = 425;
  out.buses[0].counters[0] = 100;
  return out;
}

EventRecord event(std::uint64_t number) {
  EventRecord out;
  out.number = number;
  return out;
}

Told::Told() {
  HelloRecord hello{"lift", "0.3.0", 42, kStarted - 10 * kSecond, 2, 1, false, false};
  tell(hello);
  BusInfoRecord bus;
  bus.name = "serial";
  bus.protocol = "kinco";
  bus.endpoint = "/dev/ttyUSB0 at 38400";
  bus.planned_load_permille = 400;
  tell(bus);
  tell(info(1, "hoist"));
  tell(info(3, "turn"));
  tell(FaultWordRecord{"kinco-jd", 0, 4, false, 0, 0x3210, "the DC bus is too high", "a braking resistor"});
}

void Told::tell(const Record& record, SteadyNs after_start) { ASSERT_TRUE(stores_.take(record, at(after_start))); }

void Told::tell(const AxisSample& sample, SteadyNs after_start) {
  SamplesRecord record;
  record.at = kStarted + after_start;
  record.axes = {sample};
  tell(Record(record), after_start);
}

Json Told::axis(std::uint16_t number, SteadyNs after_start) const {
  return axis_json(stores_.picture, *stores_.picture.find(number), at(after_start));
}

std::vector<std::string> Told::blocks(std::uint16_t number, SteadyNs after_start) const {
  std::vector<std::string> out;
  for (const Block& block : blocked_by(stores_.picture, *stores_.picture.find(number), kStarted + after_start))
    out.push_back(block.word);
  return out;
}

Request get(const std::string& target) {
  Request out;
  out.target = target;
  out.hosts = 1;
  out.host = "localhost:8080";
  return out;
}

Answer answer_to(const Request& request, Told& told, SteadyNs after_start) {
  return answer(request, told.stores(), Served{}, at(after_start));
}
Answer asked(Told& told, const std::string& target, SteadyNs after_start) {
  return answer_to(get(target), told, after_start);
}

Json body_of(const Answer& answer) { return Json::parse(std::get<Response>(answer.what).body()); }
std::string detail_of(const Answer& answer) { return body_of(answer)["detail"].get<std::string>(); }
unsigned status_of(const Answer& answer) { return std::get<Response>(answer.what).status; }

}  // namespace axisgate::web
