// SPDX-License-Identifier: Apache-2.0
#include "tests/judged/program.hpp"

#include <rapidcheck.h>

#include "tests/judged/drawing.hpp"
#include "tests/model/contract.hpp"

namespace axisgate::test::judged {
namespace {

constexpr int kSteps = 60;  // at most

using Weighted = std::pair<std::size_t, Deed>;

rc::Gen<Deed> deed(Weather weather) {
  const std::initializer_list<Weighted> calm{
      {2, Deed::wait},      {6, Deed::command},     {6, Deed::command_by_id}, {8, Deed::order},
      {6, Deed::image},     {2, Deed::zeros},       {4, Deed::target},        {2, Deed::parameter},
      {2, Deed::insist},    {1, Deed::mode_block},  {1, Deed::word_block},    {2, Deed::word},
      {4, Deed::coil},      {3, Deed::start_coils}, {1, Deed::cross},         {3, Deed::again},
      {3, Deed::scan},      {3, Deed::button},      {3, Deed::read},          {1, Deed::release},
      {1, Deed::reconnect}, {1, Deed::vanish},      {1, Deed::object},        {1, Deed::look_up},
      {3, Deed::halves},    {1, Deed::bystander},   {5, Deed::sample},        {3, Deed::once_more},
      {3, Deed::masters},   {2, Deed::dds_jog},     {1, Deed::new_writer},    {1, Deed::dds_dies},
      {4, Deed::tool},      {1, Deed::monitor},     {1, Deed::rival}};
  if (weather == Weather::calm) return rc::gen::weightedElement<Deed>(calm);
  const auto rough = rc::gen::weightedElement<Deed>({{4, Deed::lost},
                                                     {4, Deed::cut},
                                                     {4, Deed::unplug},
                                                     {2, Deed::lose},
                                                     {2, Deed::late},
                                                     {1, Deed::twice},
                                                     {1, Deed::restart},
                                                     {1, Deed::trip},
                                                     {2, Deed::crash},
                                                     {3, Deed::other_master}});
  return rc::gen::weightedOneOf<Deed>({{8, rc::gen::weightedElement<Deed>(calm)}, {1, rough}});
}

rc::Gen<std::uint8_t> below(std::size_t bound) {
  return rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::uint8_t>(0, static_cast<std::uint8_t>(bound)));
}

rc::Gen<Step> step(Weather weather) {
  return rc::gen::build<Step>(
      rc::gen::set(&Step::deed, deed(weather)), rc::gen::set(&Step::client, below(reference::kModbus)),
      rc::gen::set(&Step::command, below(kCommands.size())), rc::gen::set(&Step::id, below(5)),
      rc::gen::set(&Step::position, below(kPositions.size() + 2)),
      rc::gen::set(&Step::speed, below(kSpeeds.size() + 2)), rc::gen::set(&Step::number, below(24)),
      rc::gen::set(&Step::on), rc::gen::set(&Step::at_once), rc::gen::set(&Step::length, below(kLengths.size())),
      rc::gen::set(&Step::pause, below(kPauses.size())));
}

constexpr std::array<const char*, 45> kDeeds{
    "wait",       "command",    "command by id", "order",     "image",       "zeros",   "target",   "parameter",
    "mode block", "word block", "word",          "coil",      "start coils", "cross",   "again",    "scan",
    "button",     "tool",       "monitor",       "insist",    "rival",       "read",    "object",   "look up",
    "halves",     "bystander",  "sample",        "once more", "new writer",  "masters", "DDS dies", "DDS jog",
    "release",    "reconnect",  "vanish",        "lost",      "cut",         "unplug",  "lose",     "late",
    "twice",      "restart",    "trip",          "crash",     "other master"};

}  // namespace

Flavour flavour_of(Subject subject, std::uint64_t seed) {
  if (!has_positions(subject)) return Flavour::speeds;
  if (!has_speeds(subject)) return Flavour::moves;
  return static_cast<Flavour>(seed % 3);
}

rc::Shrinkable<std::vector<Step>> steps_of(Subject subject, Weather weather, std::uint64_t seed) {
  constexpr std::uint64_t kApart = 64;
  return rc::gen::container<std::vector<Step>>(step(weather))(
      rc::Random(seed * kApart + static_cast<std::uint64_t>(subject)), kSteps);
}

Program draw(Subject subject, Weather weather, bool leases, std::uint64_t seed) {
  return {subject, flavour_of(subject, seed), leases, steps_of(subject, weather, seed).value(),
          weather == Weather::rough ? draw_nemesis(subject, seed) : Nemesis{}};
}

std::string text(const Step& step) {
  return std::string{static_cast<char>('a' + step.client), ' '} + kDeeds.at(static_cast<std::size_t>(step.deed));
}

}  // namespace axisgate::test::judged
