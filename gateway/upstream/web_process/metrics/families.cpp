// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/metrics/families.hpp"

#include <prometheus/text_serializer.h>

#include <cctype>
#include <limits>
#include <sstream>
#include <utility>

namespace axisgate::web {
namespace {

constexpr double kNsPerSecond = 1e9;

prometheus::MetricType type_of(MetricKind kind) {
  switch (kind) {
    case MetricKind::counter:
      return prometheus::MetricType::Counter;
    case MetricKind::histogram:
      return prometheus::MetricType::Histogram;
    case MetricKind::gauge:
      break;
  }
  return prometheus::MetricType::Gauge;
}

/// In seconds; the last one has none.
double end_of(std::size_t bucket) {
  if (bucket + 1 == TimeCounts::kBuckets) return std::numeric_limits<double>::infinity();
  return static_cast<double>(TimeCounts::kFirst.count()) * static_cast<double>(1U << bucket) / kNsPerSecond;
}

}  // namespace

std::string word_label(WordKind kind, std::uint32_t number) {
  std::string out(name_of(kind, number));
  for (char& c : out) c = c == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

void Families::add(Metric metric, Labels labels, double value) {
  prometheus::ClientMetric sample;
  sample.label = std::move(labels);
  if (row(metric).kind == MetricKind::counter)
    sample.counter.value = value;
  else
    sample.gauge.value = value;
  samples_[static_cast<std::size_t>(metric)].push_back(std::move(sample));
}

void Families::add(Metric metric, Labels labels, const TimeCounts& times) {
  prometheus::ClientMetric sample;
  sample.label = std::move(labels);
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < times.counts.size(); ++i) {
    count += times.counts[i];
    sample.histogram.bucket.push_back({count, end_of(i)});
  }
  sample.histogram.sample_count = count;
  sample.histogram.sample_sum = static_cast<double>(times.sum_ns) / kNsPerSecond;
  samples_[static_cast<std::size_t>(metric)].push_back(std::move(sample));
}

std::string Families::text() && {
  std::ostringstream out;
  std::vector<prometheus::MetricFamily> one(1);
  for (const MetricRow& each : metric_rows()) {
    auto& samples = samples_[static_cast<std::size_t>(each.metric)];
    if (samples.empty()) continue;
    one[0] = {std::string(each.name), std::string(each.help), type_of(each.kind), std::move(samples)};
    prometheus::TextSerializer().Serialize(out, one);
  }
  return std::move(out).str();
}

}  // namespace axisgate::web
