// SPDX-License-Identifier: Apache-2.0
#include "tests/judged/clients.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <stdexcept>

#include "tests/model/judge.hpp"

namespace axisgate::test::judged {

using namespace reference;
using obey::Answer;

namespace {
constexpr std::uint8_t kHostOfViewer = 40;
constexpr std::uint8_t kMostWriters = 40;  // that one gateway sees in a run

/// 3.1 Panels: rows of 32 bits that `"numbers": "float"` has in turns, rpm and rpm/s, and what is 1 there.
std::int64_t one_of(std::uint16_t offset) {
  constexpr std::array<std::uint16_t, 5> kPositions{42, 68, 72, 74, 78}, kAccelerations{50, 52, 66, 70};
  constexpr std::array<std::uint16_t, 6> kVelocities{44, 48, 58, 62, 64, 76};
  const auto in = [offset](const auto& list) { return std::ranges::find(list, offset) != list.end(); };
  return in(kPositions) ? 10'000 : in(kVelocities) ? 1'000 : in(kAccelerations) ? 10 : 0;
}

/// The same write for a listener with floats.
Write in_floats(Write write) {
  if (write.coils() || write.function == fc::general_reference) return write;
  for (const auto& [offset, value] : rows_of(write)) {
    if (one_of(offset) == 0) continue;
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value) / static_cast<float>(one_of(offset)));
    const auto at = static_cast<std::size_t>(offset - write.first);
    write.words.at(at) = static_cast<std::uint16_t>(bits >> 16);
    write.words.at(at + 1) = static_cast<std::uint16_t>(bits);
  }
  return write;
}

/// Exceptions that a result stands for (3.3 Outcomes, and the DDS results of their own from 16 on).
const std::map<int, std::set<int>> kStandsFor{
    {0, {1, 2, 3}}, {2, {0}},  {3, {4}},        {4, {11}},   {5, {6}},
    {6, {6, 10}},   {7, {6}},  {8, {4, 6, 11}}, {9, {4, 6}}, {10, {0, 6}},
    {11, {4}},      {16, {2}}, {17, {3}},       {19, {6}},   {21, {kAlreadySeen}}};
}  // namespace

void Clients::connect() {
  for (std::size_t client = 0; client < kModbus; ++client) {
    modbus_[client]->be(operators_[client] ? Role::operator_ : Role::engineer, ranks_[client]);
    modbus_[client]->connect();
  }
  participant_ = static_cast<std::uint8_t>(participant_ + kMostWriters);
  dds_.emplace(plant_.stage, participant_, std::vector<std::int32_t>(strengths_.begin(), strengths_.end()));
}

std::optional<std::set<int>> Clients::answer_of(std::size_t client, std::uint64_t request) {
  if (!is_dds(client)) {
    const std::optional<Answer> answer = modbus_[client]->answer_of(request);
    return answer ? std::optional<std::set<int>>({answer->exception}) : std::nullopt;
  }
  const std::optional<std::uint8_t> result = dds_ ? dds_->result_of(request) : std::nullopt;
  if (!result) return {};
  const auto found = kStandsFor.find(*result);
  if (found == kStandsFor.end() || *result == 0) throw std::runtime_error("DDS result " + std::to_string(*result));
  return found->second;
}

std::uint64_t Clients::begin(std::size_t client, const Write& write) {
  if (is_dds(client)) return dds_->begin(write, client - kModbus);
  return modbus_[client]->begin(plant_.listener.float_numbers ? in_floats(write) : write);
}

std::uint64_t Clients::ask_for_result(std::size_t client) {
  return modbus_[client]->begin_read(obey::shown::result, 1);
}

std::optional<Clients::Posted> Clients::posted(std::size_t client, std::uint64_t asked) {
  constexpr std::uint16_t kPending = 1;
  const std::optional<Answer> answer = modbus_[client]->answer_of(asked);
  if (!answer) return {};
  if (!answer->ok()) return Posted{};
  const std::uint16_t result = answer->words.at(0);
  if (result == kPending) return Posted{.pending = true};
  return Posted{.stands_for = kStandsFor.at(result)};
}

void Clients::replace(std::size_t client, bool silently) {
  if (is_dds(client)) return dds_->replace(client - kModbus, !silently);
  if (silently)
    modbus_[client]->vanish();
  else
    modbus_[client]->disconnect();
  modbus_[client]->connect();
}

std::optional<std::string> Clients::bystand(const Step& step) {
  const auto viewer = plant_.connection_from(kHostOfViewer);
  viewer->be(Role::viewer);
  viewer->connect();
  Write write = one(row::command, step.number % 2 == 0 ? kEnable : kMove);
  if (step.number % 3 == 1) write = one_coil(step.number % coil::count, step.on);
  if (step.number % 3 == 2) write = one(row::target_velocity, kSpeeds[0]);
  constexpr int kNotAllowed = 1;
  const std::optional<Answer> answer = viewer->answer_of(viewer->begin(write));
  if (answer && answer->exception == kNotAllowed) return {};
  return "a viewer's " + text(write) + " was not refused";
}

}  // namespace axisgate::test::judged
