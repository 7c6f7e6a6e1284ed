// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/byte_line.hpp"

#include <algorithm>
#include <utility>

namespace axisgate::simulated {

ByteLine::ByteLine(std::uint32_t baud, Random random, ToHostSink sink)
    : baud_(baud), random_(random), sink_(std::move(sink)), outgoing_(baud) {}

void ByteLine::from_host(std::span<const std::uint8_t> bytes, Time now) {
  advance(now);
  if (adapter_echo_ != AdapterEcho::off) {
    outgoing_.send(std::max(host_free_, now), {0, ByteOrigin::echo, size(), {bytes.begin(), bytes.end()}});
  }
  if (adapter_echo_ == AdapterEcho::only) return advance(now);
  for (const std::uint8_t byte : bytes) {
    host_free_ = std::max(host_free_, now) + on_wire(1);
    incoming_.push_back({host_free_, byte});
  }
  advance(now);
}

void ByteLine::cut() {
  incoming_.clear();
  outgoing_.cut();
}

std::optional<Time> ByteLine::next_event() const {
  std::optional<Time> next = outgoing_.next_event();
  const auto consider = [&next](Time at) { next = next ? std::min(*next, at) : at; };
  if (!incoming_.empty()) consider(incoming_.front().at);
  for (const Drive& drive : drives_) {
    if (drive.faults.armed(DriveFault::babble)) consider(drive.next_babble);
  }
  return next;
}

void ByteLine::advance(Time now) {
  for (;;) {
    const auto next = next_event();
    if (!next || *next > now) break;
    now_ = std::max(now_, *next);
    if (outgoing_.arrives_at(*next)) {
      const Chunk chunk = outgoing_.take_arrived();
      sink_({*next, chunk.tag, chunk.origin, chunk.bytes});
    } else if (outgoing_.begins_at(*next)) {
      outgoing_.begin();
    } else if (!incoming_.empty() && incoming_.front().at == *next) {
      const IncomingByte arrived = incoming_.front();
      incoming_.pop_front();
      byte_arrives(arrived.byte, arrived.at);
    } else {
      own_accord(*next);
    }
  }
  now_ = std::max(now_, now);
  for (std::size_t position = 0; position < size(); ++position) {
    drive_advances(position, now_);
    Drive& drive = drives_[position];
    if (!drive.faults.armed(DriveFault::babble)) drive.next_babble = now_ + drive.faults.babble_period;
  }
}

void ByteLine::own_accord(Time at) {
  for (std::size_t position = 0; position < size(); ++position) babble(position, at);
}

void ByteLine::babble(std::size_t position, Time now) {
  Drive& drive = drives_[position];
  if (!drive.faults.armed(DriveFault::babble) || drive.next_babble > now) return;
  drive.next_babble = now + std::max(drive.faults.babble_period, one_millisecond);
  if (drive.faults.strikes(DriveFault::babble, random_)) {
    outgoing_.send(now, {0, ByteOrigin::noise, position, babbled(position)});
  }
}

std::vector<std::uint8_t> ByteLine::babbled(std::size_t position) { return faults(position).noise(random_); }

void ByteLine::spoil(std::size_t position, std::vector<std::uint8_t>& bytes) {
  DriveFaults& faults = drives_[position].faults;
  if (faults.strikes(DriveFault::corrupt, random_)) {
    const std::uint64_t bit = random_.below(8 * bytes.size());
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1U << (bit % 8)));
  }
  if (has(DriveFault::half) && faults.strikes(DriveFault::half, random_)) {
    bytes.resize(1 + random_.below(bytes.size() - 1));
  }
}

void ByteLine::put_noise_around(std::size_t position, std::vector<std::uint8_t>& bytes) {
  DriveFaults& faults = drives_[position].faults;
  if (faults.strikes(DriveFault::noise_before, random_)) {
    const auto before = faults.noise(random_);
    bytes.insert(bytes.begin(), before.begin(), before.end());
  }
  if (faults.strikes(DriveFault::noise_after, random_)) {
    const auto after = faults.noise(random_);
    bytes.insert(bytes.end(), after.begin(), after.end());
  }
}

}  // namespace axisgate::simulated
