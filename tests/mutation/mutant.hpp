// SPDX-License-Identifier: Apache-2.0
#pragma once

// Put before the first line of a source that holds mutants (tests/mutation/run), never part of a build that ships.
#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <string>

#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wimplicit-fallthrough"
#pragma GCC diagnostic ignored "-Wreturn-type"
#pragma GCC diagnostic ignored "-Wunused-variable"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wparentheses"

// GoogleTest's UnitTest::GetInstance() and current_test_info(), where the program has them: a mutated source includes
// no GoogleTest.
extern "C" __attribute__((weak)) void* axisgate_unit_test() __asm__("_ZN7testing8UnitTest11GetInstanceEv");
extern "C" __attribute__((weak)) const std::string* axisgate_test_info(void*) __asm__(
    "_ZNK7testing8UnitTest17current_test_infoEv");

/// Which mutants each case of a program came to ("*": outside of any case), left for the tool when the program ends.
class AxisgateMutantsReached {
 public:
  ~AxisgateMutantsReached() {
    std::FILE* file = path_ == nullptr ? nullptr : std::fopen(path_, "a");
    if (file == nullptr) return;
    for (const auto& [name, marks] : cases_) {
      std::fprintf(file, "%s", name.c_str());
      for (std::size_t id = 0; id < marks.size(); ++id)
        if (marks[id]) std::fprintf(file, " %zu", id);
      std::fprintf(file, "\n");
    }
    std::fclose(file);
    path_ = nullptr;
  }

  void mark(int id) {
    if (path_ == nullptr) return;
    const std::lock_guard lock{mutex_};
    const std::string* info = axisgate_unit_test == nullptr ? nullptr : axisgate_test_info(axisgate_unit_test());
    if (info != last_ || marks_ == nullptr) {
      // A TestInfo begins with the names of the suite and of the case.
      marks_ = &cases_[info == nullptr ? "*" : info[0] + "." + info[1]];
      last_ = info;
    }
    marks_->at(static_cast<std::size_t>(id)) = true;
  }

 private:
  using Marks = std::array<bool, 2000>;
  const char* path_ = std::getenv("AXISGATE_MUTANTS_REACHED");
  std::mutex mutex_;
  std::map<std::string, Marks> cases_;
  const std::string* last_ = nullptr;
  Marks* marks_ = nullptr;
};

/// Whether the environment chooses this one.
inline bool axisgate_mutant(int id) {
  static AxisgateMutantsReached reached;
  static const int chosen = [] {
    const char* text = std::getenv("AXISGATE_MUTANT");
    return text == nullptr ? 0 : std::atoi(text);
  }();
  reached.mark(id);
  return chosen == id;
}
