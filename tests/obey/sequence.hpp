// Random writes of two clients over every way in, for one drive. Promises that equal seeds give equal sequences, that
// values repeat often, and that no value is out of any drive's range. Never knows what a write will do.
#pragma once

#include <vector>

#include "tests/obey/subject.hpp"
#include "tests/obey/write.hpp"
#include "tests/simulated/random.hpp"

namespace axisgate::test::obey {

struct Step {
  std::size_t client = 0;
  Write write{};
  std::int64_t pause_ms = 0;  ///< after it
};
[[nodiscard]] std::string text(const Step& step);

/// What a sequence is about: a raw mode belongs to moves or to speeds.
enum class Flavour : std::uint8_t { moves, speeds, both };

class Sequence {
 public:
  /// `profile`: rows 48 to 52 as the drive holds them; some clients write these in their blocks, some write zeros.
  Sequence(Subject subject, std::uint64_t seed, std::size_t clients, Rows profile);

  [[nodiscard]] Flavour flavour() const { return flavour_; }
  Step next();
  /// Then a start by one of the clients, or nothing. Its own targets are not written again.
  std::vector<Step> ending();

 private:
  struct Writer {
    std::int64_t id = 0;
    std::int64_t word = 0;
    bool zeros = false;  ///< where others have the profile's rows
    Rows last{};
  };
  std::uint64_t below(std::uint64_t bound) { return random_.below(bound); }
  bool once_in(std::uint64_t n) { return below(n) == 0; }
  template <class List>
  auto any_of(const List& list) {
    return list[static_cast<std::size_t>(below(list.size()))];
  }
  std::int64_t position();
  std::int64_t speed();
  std::int64_t start_command();
  std::int64_t some_command();
  std::int64_t word(Writer& writer);
  std::int64_t id(Writer& writer);
  Rows targets(Writer& writer);
  Write single(Writer& writer);
  Write registers(Writer& writer);
  Write some_coil();
  Write some_coils();

  Subject subject_;
  simulated::Random random_;
  std::size_t clients_;
  Rows profile_;
  Flavour flavour_;
  std::array<Writer, 2> writers_{};
};

}  // namespace axisgate::test::obey
