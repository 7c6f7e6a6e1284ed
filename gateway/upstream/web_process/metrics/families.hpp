// SPDX-License-Identifier: Apache-2.0
// Samples by metric, and the text that Prometheus reads (exposition format 0.0.4).
// Promises help and type of each metric that has a sample, labels escaped whatever stands in them, and histograms whose
// buckets, sum and count are one look. Never keeps a value for the next answer.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <prometheus/metric_family.h>

#include "gateway/core/time_counts.hpp"
#include "gateway/core/words.hpp"
#include "gateway/upstream/web_process/metrics/metric_table.hpp"

namespace axisgate::web {

/// A word as labels have it: "error_stop", "dds_process_down". `axisgate explain` knows it so as well.
[[nodiscard]] std::string word_label(WordKind kind, std::uint32_t number);

class Families {
 public:
  using Labels = std::vector<prometheus::ClientMetric::Label>;

  /// Of a gauge or a counter.
  void add(Metric metric, Labels labels, double value);
  void add(Metric metric, Labels labels, const TimeCounts& times);
  /// Metrics without a sample are not in it.
  [[nodiscard]] std::string text() &&;

 private:
  std::array<std::vector<prometheus::ClientMetric>, kMetrics> samples_;
};

}  // namespace axisgate::web
