// SPDX-License-Identifier: Apache-2.0
// The manuals' conversions of speed, acceleration, current and position, through the shipped profiles.
#include <cmath>
#include <regex>

#include "tests/profiles/resolving.hpp"

namespace axisgate::profile {
namespace {

using nlohmann::json;

json conversions(const std::string& drive) { return manual(drive)["conversions"]; }

model::DriveModel with(const std::string& drive, std::int64_t counts, const std::string& peak) {
  ResolveInput input = one_axis();
  input.constants["encoder_counts_per_rev"] = Rational(counts);
  input.constants["peak_current_a"] = *Rational::parse(peak);
  input.constants["rated_current_a"] = Rational(10);
  if (drive == "kinco-md") input.constants["rated_speed_rpm"] = Rational(10000);
  return resolved(shipped(drive), input);
}

std::int64_t in_units(const std::string& decimal, std::int64_t per_unit) {
  return (*Rational::parse(decimal) * Rational(per_unit)).scale(1).value();
}

/// "200 rpm, enc 10000", "-100 rpm, resolution 65536"
TEST(KincoConversions, EverySpeedAndAccelerationOfTheManualsComesOutRounded) {
  static const std::regex form(R"((-?[0-9.]+) (rpm|rps/s), (?:enc|resolution) ([0-9]+))");
  int checked = 0;
  for (const std::string drive : {"kinco-jd", "kinco-md"}) {
    for (const json& row : conversions(drive)) {
      std::smatch found;
      const std::string text = row["engineering"];
      if (!std::regex_match(text, found, form)) continue;
      SCOPED_TRACE(drive + ": " + text);
      const model::DriveModel model = with(drive, std::stoll(found[3]), "36");
      const bool speed = found[2] == "rpm";
      const Quantity quantity = speed ? Quantity::homing_speed_switch : Quantity::profile_acceleration;
      const std::int64_t value = in_units(found[1], speed ? 1000 : 600);
      const Rational scale = binding(model, quantity).raw_per_unit;
      const double exact = row["exact"].get<double>();
      // A register unit is the finest that can be asked for: 610.352 rps/s lies between two of 0.1 rpm/s.
      EXPECT_NEAR((Rational(value) * scale).to_double(), exact, scale.to_double() / 2 + 1e-3);
      EXPECT_NEAR(static_cast<double>(scale.scale(value).value()), exact, scale.to_double() / 2 + 0.501);
      ++checked;
    }
  }
  EXPECT_GE(checked, 25);
}

TEST(KincoConversions, TheMdManualsRoundedSpeedsComeOutToTheDigit) {
  static const std::regex form(R"((-?[0-9]+) rpm, resolution 65536)");
  const model::DriveModel model = with("kinco-md", 65536, "36");
  int checked = 0;
  for (const json& row : conversions("kinco-md")) {
    std::smatch found;
    const std::string text = row["engineering"];
    if (!std::regex_match(text, found, form)) continue;
    const auto raw = sent(model, Quantity::target_velocity, std::stoll(found[1]) * 1000);
    if (std::stoll(found[1]) >= 120000) {
      EXPECT_EQ(raw, std::nullopt) << text << " needs more than 32 bits";
    } else {
      EXPECT_EQ(raw, row["raw"].get<std::int64_t>()) << text;
    }
    ++checked;
  }
  EXPECT_GE(checked, 10);
}

TEST(KincoConversions, CurrentsOfBothManualsComeOut) {
  static const std::regex md(R"(([0-9.]+) Arms, Ipeak ([0-9]+) Ap)");
  static const std::regex jd(R"((-?[0-9.]+) Ap, JD430 \(Ipeak 27.5 A\))");
  int checked = 0;
  for (const std::string drive : {"kinco-jd", "kinco-md"}) {
    for (const json& row : conversions(drive)) {
      std::smatch found;
      const std::string text = row["engineering"];
      const bool peak = std::regex_match(text, found, jd);
      if (!peak && !std::regex_match(text, found, md)) continue;
      const model::DriveModel model = with(drive, 10000, peak ? std::string("27.5") : found[2].str());
      const model::Binding& current = binding(model, Quantity::current_actual);
      // Ap = 1.414 * Arms; registers count 0.01 A rms.
      const double registers = std::stod(found[1]) / (peak ? 1.414 : 1.0) * 100;
      EXPECT_NEAR(registers * current.raw_per_unit.to_double(),
                  row.contains("exact") ? row["exact"].get<double>() : row["raw"].get<double>(), 0.5)
          << text;
      const auto shown = current.to_register(row["raw"].get<std::int64_t>());
      ASSERT_TRUE(shown) << text;
      EXPECT_NEAR(static_cast<double>(*shown), registers, 2.0) << text;
      ++checked;
    }
  }
  EXPECT_GE(checked, 10);
}

}  // namespace
}  // namespace axisgate::profile
