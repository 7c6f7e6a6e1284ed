// SPDX-License-Identifier: Apache-2.0
#include "tests/judged/plague.hpp"

#include <algorithm>

namespace axisgate::test::judged {
namespace {

using Frame = std::vector<std::uint8_t>;

constexpr std::uint8_t kHostOfCook = 60, kHostOfCrowd = 61;
constexpr std::size_t kMostOfCrowd = 64, kMostOwed = 4;
constexpr std::int64_t kLongestAnswerMs = 10'000;

void add16(Frame& out, std::uint64_t value) {
  out.push_back(static_cast<std::uint8_t>(value >> 8));
  out.push_back(static_cast<std::uint8_t>(value));
}

/// MBAP and a PDU that reads, or that no gateway carries out.
Frame request(simulated::Random& random) {
  constexpr std::array<std::uint8_t, 4> kReads{1, 2, 3, 4};
  constexpr std::array<std::uint8_t, 7> kActs{5, 6, 15, 16, 22, 23, 43};
  constexpr std::uint64_t kBeyond = 45'000;  // no axis has rows there
  Frame pdu;
  switch (random.below(4)) {
    case 0:  // somewhere, and so many
      pdu.push_back(kReads.at(random.below(kReads.size())));
      add16(pdu, random.below(4'000));
      add16(pdu, random.below(300));
      break;
    case 1:  // a function that is none, with anything behind it
      do pdu.assign(1, random.byte());
      while (std::ranges::find(kActs, pdu[0]) != kActs.end());
      for (std::uint64_t more = random.below(30); more > 0; --more) pdu.push_back(random.byte());
      break;
    case 2:  // a write whose lengths do not fit each other
      pdu.push_back(random.chance(0.5) ? 16 : 15);
      add16(pdu, 100 + random.below(100));
      add16(pdu, 1 + random.below(20));
      pdu.push_back(static_cast<std::uint8_t>(41 + random.below(100)));
      for (std::uint64_t more = random.below(40); more > 0; --more) pdu.push_back(random.byte());
      break;
    default:  // a write of what is not there
      pdu.push_back(random.chance(0.5) ? 5 : 6);
      add16(pdu, kBeyond + random.below(100));
      add16(pdu, random.chance(0.5) ? 0xFF00 : random.below(65'536));
  }
  Frame out;
  add16(out, random.below(65'536));
  add16(out, 0);
  add16(out, pdu.size() + 1);
  out.push_back(1);
  out.insert(out.end(), pdu.begin(), pdu.end());
  return out;
}

}  // namespace

void Plague::set_rates(bool on) {
  strikes_ = false;
  for (const obey::Strike how : obey::kStrikes) {
    if (nemesis_.strike(how) == 0) continue;
    // A request that is lost is struck one by one: a neighbour's cut wire has the switch of its own.
    if (how == obey::Strike::lose_request)
      strikes_ = on || strikes_;
    else if (plant_.strike_often(how, on ? nemesis_.strike(how) : 0, nemesis_.late_by))
      strikes_ = on || strikes_;
  }
}

std::optional<std::string> Plague::rage(std::int64_t now_ms) {
  now_ms_ = now_ms;
  if (nemesis_.until_ms == 0 || ended_ || now_ms < nemesis_.from_ms) return {};
  if (!began_) {
    began_ = true;
    set_rates(true);
  }
  if (now_ms >= nemesis_.until_ms) {
    ended_ = true;
    set_rates(false);
    plant_.strike(obey::Strike::lose_request, 0);
    crowd_.clear();
    cook_.reset();
    return {};
  }
  if (random_.chance(nemesis_.strike(obey::Strike::lose_request))) plant_.strike(obey::Strike::lose_request);
  if (!plant_.stage.gateway_runs()) {
    cook_.reset();
    crowd_.clear();
    return {};
  }
  if (random_.chance(nemesis_.storm)) throng();
  if (random_.chance(nemesis_.stall)) {
    stall_ = std::chrono::milliseconds(1 + random_.below(static_cast<std::uint64_t>(nemesis_.longest_stall_ms)));
    ++injected_.stall;
  }
  return nemesis_.soup > 0 ? cook() : std::nullopt;
}

// What is whole is answered, once; what is no frame ends its own connection and no other.
std::optional<std::string> Plague::cook() {
  if (!cook_) {
    cook_ = plant_.connection_from(kHostOfCook);
    owed_ = 0;
  }
  if (!cook_->connected()) return "a client that says whole requests was closed";
  if (cook_->replies() > owed_) return "a request was answered twice";
  if (cook_->replies() == owed_) owed_since_ms_ = now_ms_;
  if (now_ms_ - owed_since_ms_ > kLongestAnswerMs) return "a request without sense was never answered";
  if (!random_.chance(nemesis_.soup)) return {};
  ++injected_.soup;
  if (random_.chance(0.1)) {
    const auto babbler = plant_.connection_from(kHostOfCook);
    Frame bytes = request(random_);
    bytes[2] = 0x47;  // another protocol
    babbler->say(bytes);
    if (babbler->connected()) return "what is no frame has not ended its connection";
  }
  if (owed_ - cook_->replies() >= kMostOwed) return {};
  ++owed_;
  cook_->say(request(random_));
  return {};
}

// Some say nothing, some half a request, some a whole one; some go at once, some with a later storm.
void Plague::throng() {
  constexpr std::uint64_t kMost = 30;
  ++injected_.storm;
  std::erase_if(crowd_, [this](const auto&) { return random_.chance(0.5); });
  for (std::uint64_t more = 1 + random_.below(kMost); more > 0; --more) {
    auto one = plant_.connection_from(kHostOfCrowd);
    Frame bytes = request(random_);
    bytes.resize(random_.below(bytes.size() + 1));
    if (!bytes.empty()) one->say(bytes);
    if (random_.chance(0.3)) one->vanish();
    if (random_.chance(0.5) && crowd_.size() < kMostOfCrowd) crowd_.push_back(std::move(one));
  }
}

void Plague::count_strikes() {
  for (const obey::Strike how : obey::kStrikes)
    injected_.strikes.at(static_cast<std::size_t>(how)) = plant_.struck(how);
}

}  // namespace axisgate::test::judged
