// What scenes are made of: how their words name things, what every line has, what the world sees of each kind of drive.
// Promises the same words for the same things in all scenes. Never decides what is right.
#pragma once

#include <algorithm>

#include "tests/unit/simulated/scenes.hpp"

namespace axisgate::simulated {

// "60F9.19:2@3": an object or register, how wide it is written, and whose.
struct Name {
  explicit Name(const std::string& text) {
    const std::size_t at = text.find('@');
    if (at != std::string::npos) station = static_cast<std::uint8_t>(std::stoi(text.substr(at + 1)));
    const std::size_t colon = text.find(':');
    if (colon != std::string::npos) width = std::stoi(text.substr(colon + 1));
    word = text.substr(0, std::min(at, colon));
  }
  ObjectKey key() const {
    const std::size_t point = word.find('.');
    const auto hex = [](const std::string& digits) { return std::stoi(digits, nullptr, 16); };
    return {static_cast<std::uint16_t>(hex(word.substr(0, point))),
            static_cast<std::uint8_t>(point == std::string::npos ? 0 : hex(word.substr(point + 1)))};
  }
  std::string word;
  std::uint8_t station = 1;
  int width = 0;
};

inline std::int64_t whole(const std::string& text) { return std::stoll(text, nullptr, 0); }
inline std::uint16_t bits(const std::string& text) { return static_cast<std::uint16_t>(whole(text)); }
inline bool on(const Row& words) { return words.back() == "on"; }

template <class Type>
std::function<std::int64_t()> count(Type of) {
  return [of] { return static_cast<std::int64_t>(of()); };
}

// What all lines have.
template <class Bench>
void add_line(Scene& scene, const std::shared_ptr<Bench>& bench) {
  scene.pass = [bench](Time time) { bench->pass(time); };
  scene.acts["restart"] = [bench](const Row&) { bench->line.restart(0, bench->now); };
  scene.phrases["reboot"] = "restart; pass 2s";
  scene.acts["fault"] = [bench](const Row& words) {
    bench->line.faults(0).next(*drive_fault_named(words[0]), words.size() > 1 ? std::stoul(words[1]) : 1);
  };
  scene.acts["always"] = [bench](const Row& words) { bench->line.faults(0).set_rate(*drive_fault_named(words[0]), 1); };
  scene.acts["well"] = [bench](const Row&) { bench->line.faults(0).clear(); };
  // Settings of the switches; times in milliseconds.
  scene.acts["late_by"] = [bench](const Row& words) { bench->line.faults(0).late_by = milliseconds(whole(words[0])); };
  scene.acts["babble_period"] = [bench](const Row& words) {
    bench->line.faults(0).babble_period = milliseconds(whole(words[0]));
  };
  scene.acts["babble_id"] = [bench](const Row& words) { bench->line.faults(0).babble_id = bits(words[0]); };
  scene.acts["exception_code"] = [bench](const Row& words) {
    bench->line.faults(0).exception_code = static_cast<std::uint8_t>(whole(words[0]));
  };
  scene.acts["abort_code"] = [bench](const Row& words) {
    bench->line.faults(0).abort_code = static_cast<std::uint32_t>(whole(words[0]));
  };
  scene.acts["restart_acts"] = [bench](const Row& words) { bench->line.faults(0).restart_acts = on(words); };
  scene.acts["listen"] = [bench](const Row&) { bench->received.clear(); };
  scene.acts["cut"] = [bench](const Row&) { bench->line.cut(); };
  scene.facts["arrived"] = count([bench] { return bench->received.size(); });
  scene.facts["heard"] = count([bench] { return bench->line.requests_heard(); });
}

template <class Bench>
void add_bytes(Scene& scene, const std::shared_ptr<Bench>& bench) {
  add_line(scene, bench);
  scene.send = [bench](const std::string& hex) { bench->exchange(from_hex(hex)); };
  scene.received = [bench] { return to_hex(bench->received); };
}

template <class Send>
void add_controlword(Scene& scene, Send send) {
  scene.acts["control"] = [send](const Row& words) {
    for (const std::string& word : words) send(static_cast<std::uint16_t>(std::stoi(word, nullptr, 16)));
  };
}

// `owner` keeps the drive.
void add_kinco(Scene& scene, const std::shared_ptr<void>& owner, KincoDrive& drive);
void add_leadshine(Scene& scene, const std::shared_ptr<void>& owner, LeadshineDrive& drive);
void add_keya(Scene& scene, const std::shared_ptr<void>& owner, KeyaDrive& drive);
void add_id286pro(Scene& scene, const std::shared_ptr<void>& owner, Id286pro& drive);

}  // namespace axisgate::simulated
