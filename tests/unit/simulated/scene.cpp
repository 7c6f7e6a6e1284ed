// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "tests/unit/simulated/script.hpp"

namespace axisgate::simulated {
namespace {

// "option late_by 260": of the fault switches; times in milliseconds.
void set_option(DriveFaults& faults, const std::string& name, std::int64_t value) {
  const std::map<std::string, std::function<void()>> options{
      {"late_by", [&] { faults.late_by = milliseconds(value); }},
      {"exception_code", [&] { faults.exception_code = static_cast<std::uint8_t>(value); }},
      {"abort_code", [&] { faults.abort_code = static_cast<std::uint32_t>(value); }},
      {"restart_acts", [&] { faults.restart_acts = value != 0; }},
      {"split_gap", [&] { faults.split_gap = milliseconds(value); }},
      {"glitch_bytes", [&] { faults.glitch_bytes = static_cast<std::size_t>(value); }},
      {"glitch_value", [&] { faults.glitch_value = static_cast<std::uint8_t>(value); }},
      {"glitch_lead", [&] { faults.glitch_lead = milliseconds(value); }},
      {"babble_period", [&] { faults.babble_period = milliseconds(value); }},
      {"babble_id", [&] { faults.babble_id = static_cast<std::uint32_t>(value); }},
  };
  options.at(name)();
}

int bits_apart(const Bytes& one, const Bytes& other) {
  int bits = one.size() == other.size() ? 0 : 1000;
  for (std::size_t i = 0; bits < 1000 && i < one.size(); ++i) bits += std::popcount(unsigned{one[i]} ^ other[i]);
  return bits;
}

}  // namespace

std::int64_t Scene::fact(const std::string& name) {
  if (name == "arrived") return static_cast<std::int64_t>(bench.received().size());
  if (name == "pieces") return static_cast<std::int64_t>(bench.arrivals.size());
  if (name == "heard") return static_cast<std::int64_t>(bench.line().requests_heard());
  if (name == "rate") return bench.bus().bit_rate();
  if (name == "enabled") return bench.tell({"state"}) == "operation_enabled" ? 1 : 0;
  if (name == "physical") {
    return counts_of((bench.kinco() != nullptr ? bench.kinco()->axis() : bench.id286pro()->axis()).physical());
  }
  if (name[1] != '.') return whole(bench.tell({name}));
  const bool first = name[0] == 'a';  // of a Keya's two motors
  if (name.ends_with(".value")) return bench.keya()->at(first ? motor_a : motor_b).value();
  return whole(words_of(bench.tell({name.substr(2)})).at(first ? 0 : 1));
}

// How what came back stands to the reply that was remembered. Nothing: it is no word for that.
std::optional<bool> Scene::stands(const std::string& word) const {
  const Bytes came = bench.received();
  const Bytes& reply = remembered_;
  const std::size_t shorter = std::min(came.size(), reply.size());
  const bool begins = std::ranges::equal(std::span(came).first(shorter), std::span(reply).first(shorter));
  if (word == "same") return came == reply;
  if (word == "changed") return !came.empty() && came != reply;
  if (word == "begins") return begins && came.size() > reply.size();
  if (word == "ends") return came.size() > reply.size() && std::equal(reply.rbegin(), reply.rend(), came.rbegin());
  if (word == "breaks_off") return begins && !came.empty() && came.size() < reply.size();
  if (word == "twice") return begins && came.size() == 2 * reply.size() && bench.arrivals.at(1).bytes == reply;
  if (word == "one_bit") return bits_apart(came, reply) == 1;
  if (word != "unasked") return std::nullopt;
  return std::ranges::all_of(bench.arrivals,
                             [](const auto& it) { return it.tag == 0 && it.origin == ByteOrigin::noise; });
}

bool Scene::act(const Row& words) {
  const std::string& word = words[0];
  if (const auto right = stands(word)) {
    EXPECT_TRUE(*right) << to_hex(bench.received());
  } else if (word == "remember") {
    remembered_ = bench.received();
  } else if (word == "restart") {
    bench.line().restart(words.size() > 1 ? std::stoul(words[1]) : 0, bench.now);
  } else if (word == "next" || word == "always") {
    const DriveFault fault = drive_fault_named(words[1]).value();
    EXPECT_TRUE(bench.line().has(fault));
    if (word == "next") bench.faults().next(fault, words.size() > 2 ? std::stoul(words[2]) : 1);
    if (word == "always") bench.faults().set_rate(fault, 1);
  } else if (word == "well") {
    bench.faults().clear();
  } else if (word == "option" && words[1] == "reply_delay") {
    bench.line().set_reply_delay(milliseconds(whole(words[2])));
  } else if (word == "option") {
    set_option(bench.faults(), words[1], whole(words[2]));
  } else if (word == "listen") {
    bench.arrivals.clear();
  } else if (word == "echo") {
    bench.line().set_echo(words[1] == "only" ? AdapterEcho::only
                          : words[1] == "on" ? AdapterEcho::on
                                             : AdapterEcho::off);
  } else if (word == "cut") {
    bench.line().cut();
  } else if (word == "bus_off") {
    bench.port.can->set_bus_off(words[1] == "on", bench.now);
  } else if (word == "no_acknowledge") {
    bench.port.can->miss_acknowledge(bench.now);
  } else if (word == "control") {
    for (std::size_t i = 1; i < words.size(); ++i) (void)write(Name("6040"), std::stoi(words[i], nullptr, 16));
  } else {
    return false;
  }
  return true;
}

}  // namespace axisgate::simulated
