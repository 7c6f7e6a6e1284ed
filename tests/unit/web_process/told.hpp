// SPDX-License-Identifier: Apache-2.0
// A gateway that tells a picture what a test says: two axes on one bus.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gateway/image/quantity.hpp"
#include "gateway/upstream/web_process/api/reception.hpp"
#include "gateway/upstream/web_process/picture/picture.hpp"

namespace axisgate::web {

using Json = nlohmann::ordered_json;

inline constexpr SteadyNs kStarted = 1000 * kSecond;
/// 2026-11-28T20:40:00Z at kStarted.
inline constexpr std::int64_t kToUtc = 1'795'898'400 * kSecond - kStarted;
[[nodiscard]] inline Now at(SteadyNs after_start) { return {kStarted + after_start, kToUtc}; }

[[nodiscard]] std::uint16_t bits_of(std::initializer_list<AxisInput> inputs);

/// A sample of an axis that stands enabled at 1.5 turns, everything good.
[[nodiscard]] AxisSample standing(std::uint16_t axis);
void set(AxisSample& sample, Quantity quantity, std::int32_t value, std::uint32_t age_us = 0);
[[nodiscard]] StatisticsRecord statistics();
/// One of the gateway's own.
[[nodiscard]] EventRecord event(std::uint64_t number);

/// Told by a gateway "lift" with axes 1 ("hoist") and 3 ("turn") on the bus "serial".
class Told {
 public:
  Told();
  void tell(const Record& record, SteadyNs after_start = 0);
  void tell(const AxisSample& sample, SteadyNs after_start = 0);
  [[nodiscard]] Picture& picture() { return stores_.picture; }
  [[nodiscard]] Stores& stores() { return stores_; }
  /// The axis as the API answers it.
  [[nodiscard]] Json axis(std::uint16_t number, SteadyNs after_start = 0) const;
  /// Words of what blocks it.
  [[nodiscard]] std::vector<std::string> blocks(std::uint16_t number, SteadyNs after_start = 0) const;

 private:
  Stores stores_{std::size_t{4} << 20};
};

[[nodiscard]] Request get(const std::string& target);
/// Of a GET from this computer to "localhost".
[[nodiscard]] Answer asked(Told& told, const std::string& target, SteadyNs after_start = 0);
[[nodiscard]] Answer answer_to(const Request& request, Told& told, SteadyNs after_start = 0);
[[nodiscard]] Json body_of(const Answer& answer);
[[nodiscard]] unsigned status_of(const Answer& answer);
/// Of a refusal.
[[nodiscard]] std::string detail_of(const Answer& answer);

}  // namespace axisgate::web
