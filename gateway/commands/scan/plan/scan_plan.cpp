// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/scan/plan/scan_plan.hpp"

#include <algorithm>
#include <charconv>

namespace axisgate::commands {
namespace {

constexpr ObjectAddress kDeviceType{0x1000, 0};
constexpr ObjectAddress kDeviceName{0x1008, 0};
constexpr std::uint16_t kIdentity = 0x1018;
constexpr std::size_t kMaxName = 64;
constexpr std::uint8_t kWidestField = 4;
constexpr std::string_view kGeneric = "cia402-generic";

/// CiA 301: what stands there is for each maker to say.
bool is_makers_own(ObjectAddress address) { return address.index >= 0x2000 && address.index < 0x6000; }

/// 1000h: the number of the device profile is its low word.
bool is_cia402(const FoundNode& node) { return node.device_type && (*node.device_type & 0xFFFFU) == 0x0192U; }

const profile::Place* place_of(const profile::Object& object) {
  return object.readable && !object.is_part() ? object.place("canopen") : nullptr;
}

std::optional<std::uint32_t> number_of(const bus::ExchangeResult& result) {
  if (result.code != Errc::ok || result.fields.empty()) return std::nullopt;
  return result.fields.front().raw;
}

/// A name of four characters or less comes as a field.
std::string characters(const bus::ExchangeResult& result) {
  std::string out;
  const auto add = [&](std::uint8_t byte) {
    if (out.size() < kMaxName && byte >= 0x20 && byte <= 0x7E) out += static_cast<char>(byte);
  };
  for (const bus::ReplyField& field : result.fields)
    for (unsigned i = 0; i < field.size; ++i) add(static_cast<std::uint8_t>(field.raw >> (8U * i)));
  if (result.bytes)
    for (const std::uint8_t byte : *result.bytes) add(byte);
  return out;
}

std::optional<std::uint8_t> node_of(std::string_view digits, std::uint8_t last) {
  std::uint8_t node = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), node);
  const bool whole = error == std::errc() && end == digits.data() + digits.size();
  return whole && node >= 1 && node <= last ? std::optional(node) : std::nullopt;
}

}  // namespace

std::optional<ScanRange> parse_scan_range(std::string_view text, std::uint8_t largest) {
  const std::size_t dash = text.find('-');
  const auto first = node_of(text.substr(0, dash), largest);
  const auto last = dash == std::string_view::npos ? first : node_of(text.substr(dash + 1), largest);
  if (!first || !last || *first > *last) return std::nullopt;
  return ScanRange{*first, *last};
}

// has/of compared without a division.
bool better_fit(const ScanFit& a, const ScanFit& b) {
  return a.has * b.of != b.has * a.of ? a.has * b.of > b.has * a.of : a.has > b.has;
}

ScanPlan::ScanPlan(const std::vector<profile::Profile>& profiles, ScanRange range) : range_(range) {
  for (const profile::Profile& profile : profiles) {
    if (!profile.protocols.contains("canopen")) continue;
    profiles_.push_back(profile);
    for (const profile::Object& object : profile.objects) {
      const profile::Place* place = place_of(object);
      const auto known = [&](const Tried& tried) { return tried.address == place->address; };
      if (place == nullptr || tried_.size() >= kMaxTried || std::ranges::any_of(tried_, known)) continue;
      tried_.push_back({place->address, {}});
    }
  }
  knock_on_next();
}

void ScanPlan::heard(const bus::UnsolicitedEvent& unsolicited) {
  using Kind = bus::UnsolicitedEvent::Kind;
  if (unsolicited.node == 0 || unsolicited.node > kLastNode) return;
  const bool alive = unsolicited.kind == Kind::present || unsolicited.kind == Kind::started;
  if (alive) heard_[unsolicited.node] = unsolicited.state;
  const auto take = [&](FoundNode& node) {
    if (node.node != unsolicited.node) return;
    if (alive) node.state = unsolicited.state;
    if (unsolicited.kind == Kind::duplicate_node) node.duplicate = true;
  };
  take(current_);
  for (FoundNode& node : found_) take(node);
}

std::optional<bus::Exchange> ScanPlan::next() const {
  bus::Exchange out;
  out.node = current_.node;
  switch (step_) {
    case Step::knock:
      out.object = kDeviceType;
      return out;
    case Step::identity:
      out.object = {kIdentity, static_cast<std::uint8_t>(at_ + 1)};
      return out;
    case Step::name:
    case Step::name_part:
      out.object = kDeviceName;
      out.part = step_ == Step::name ? bus::Part::first : bus::Part::next;
      return out;
    case Step::objects:
      out.object = tried_[at_].address;
      return out;
    case Step::over:
      break;
  }
  return std::nullopt;
}

void ScanPlan::on_result(const bus::ExchangeResult& result) {
  if (step_ == Step::over) return;
  // Whatever came, somebody is there; a bad reply is one too.
  const bool silent =
      result.code != Errc::ok && result.code != Errc::refused_by_drive && result.code != Errc::bad_reply;
  silences_ = silent ? silences_ + 1 : 0;
  if (step_ == Step::knock) {
    ++asked_;
    if (silent) return knock_on_next();
    current_.device_type = number_of(result);
    return begin(Step::identity);
  }
  if (silences_ >= kSilences) {
    current_.fell_silent = true;
    return end_node();
  }
  if (step_ == Step::identity) {
    current_.identity[at_] = number_of(result);
    if (++at_ == current_.identity.size()) begin(Step::name);
  } else if (step_ == Step::objects) {
    if (result.code == Errc::ok && !result.fields.empty()) tried_[at_].size = result.fields.front().size;
    if (++at_ == tried_.size()) end_node();
  } else {
    take_name(result);
  }
}

void ScanPlan::take_name(const bus::ExchangeResult& result) {
  if (result.code == Errc::ok && result.more && at_ < kMaxNameParts) {
    ++at_;
    step_ = Step::name_part;
    return;
  }
  if (result.code == Errc::ok) current_.name = characters(result);
  begin(Step::objects);
}

void ScanPlan::begin(Step step) {
  step_ = step;
  at_ = 0;
  if (step == Step::objects && tried_.empty()) end_node();
}

void ScanPlan::end_node() {
  const bool widths_reported = tells_widths();
  for (const profile::Profile& profile : profiles_) judge(profile, widths_reported);
  std::ranges::stable_sort(
      current_.fits, [](const ScanFit& a, const ScanFit& b) { return a.by != b.by ? a.by < b.by : better_fit(a, b); });
  found_.push_back(current_);
  for (Tried& tried : tried_) tried.size.reset();
  knock_on_next();
}

void ScanPlan::knock_on_next() {
  silences_ = 0;
  step_ = Step::knock;
  at_ = 0;
  if (current_.node != 0) done_[current_.node] = true;
  current_ = {};
  for (const bool only_heard : {true, false}) {
    for (std::uint8_t node = range_.first; node <= range_.last; ++node) {
      if (done_[node] || (only_heard && !heard_[node])) continue;
      current_.node = node;
      current_.state = heard_[node].value_or(bus::NodeState::unknown);
      return;
    }
  }
  step_ = Step::over;
}

// A server that says no sizes, or answers all in four bytes, says of no object how wide it is.
bool ScanPlan::tells_widths() const {
  return std::ranges::any_of(tried_, [](const Tried& it) { return it.size && *it.size < kWidestField; });
}

void ScanPlan::judge(const profile::Profile& profile, bool widths_reported) {
  ScanFit fit{profile.name};
  fit.only_simulated = profile.only_simulated;
  fit.wanted = profile.wanted("canopen", {});
  int own = 0, lacks_own = 0;
  for (const profile::Object& object : profile.objects) {
    const profile::Place* place = place_of(object);
    if (place == nullptr) continue;
    const auto tried = std::ranges::find(tried_, place->address, &Tried::address);
    if (tried == tried_.end()) continue;
    const std::uint8_t size = place->size;
    const auto fits_in = [&](std::uint8_t answered) {
      return answered == size || (object.any_width && answered < size) || (!widths_reported && answered > size);
    };
    const bool has = tried->size && fits_in(*tried->size);
    ++fit.of;
    fit.has += has ? 1 : 0;
    if (!is_makers_own(place->address)) continue;
    ++own;
    lacks_own += has ? 0 : 1;
  }
  if (fit.of == 0 || 2 * fit.has < fit.of) return;
  if (profile.identity) {
    const std::optional<std::size_t> other = profile.identity->other_in(current_.identity);
    if (other && *other > 0) current_.of_vendor.push_back(profile.name);
    if (other || !current_.identity[0]) return;
    fit.by = ScanFit::By::vendor;
  } else if (profile.name == kGeneric) {
    if (!is_cia402(current_)) return;
    fit.by = ScanFit::By::device_type;
  } else if (own == 0 || lacks_own > 0) {
    if (fit.has == fit.of) current_.nameless.push_back(profile.name);
    return;
  }
  current_.fits.push_back(std::move(fit));
}

std::vector<FoundNode> ScanPlan::found() const {
  std::vector<FoundNode> out = found_;
  std::ranges::sort(out, [](const FoundNode& a, const FoundNode& b) { return a.node < b.node; });
  return out;
}

}  // namespace axisgate::commands
