#include "tests/judged/clients.hpp"

#include <map>
#include <stdexcept>

namespace axisgate::test::judged {

using namespace model;
using obey::Answer;

namespace {
constexpr std::uint8_t kHostOfViewer = 40;
constexpr std::uint8_t kMostWriters = 40;  // that one gateway sees in a run
}  // namespace

void Clients::connect() {
  for (std::size_t client = 0; client < kDds; ++client) {
    modbus_[client]->be(Role::engineer, kRanks[client]);
    modbus_[client]->connect();
  }
  participant_ = static_cast<std::uint8_t>(participant_ + kMostWriters);
  dds_.emplace(plant_.stage, participant_);
}

std::optional<std::set<int>> Clients::answer_of(std::size_t client, std::uint64_t request) {
  if (client != kDds) {
    const std::optional<Answer> answer = modbus_[client]->answer_of(request);
    return answer ? std::optional<std::set<int>>({answer->exception}) : std::nullopt;
  }
  const std::optional<std::uint8_t> result = dds_ ? dds_->result_of(request) : std::nullopt;
  if (!result) return {};
  // A12, and the DDS results of their own from 16 on (schemas/axisgate.idl), as 3.3's table has them.
  static const std::map<int, std::set<int>> kStandsFor{{2, {0}},     {3, {4}},  {4, {11}},       {5, {6}},
                                                       {6, {6, 10}}, {7, {6}},  {8, {4, 6, 11}}, {9, {4, 6}},
                                                       {11, {4}},    {16, {2}}, {17, {3}},       {19, {6}}};
  const auto found = kStandsFor.find(*result);
  if (found == kStandsFor.end()) throw std::runtime_error("DDS result " + std::to_string(*result));
  return found->second;
}

void Clients::replace(std::size_t client, bool silently) {
  if (client == kDds) return dds_->replace();
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
