#include "tests/unit/simulated/scene_parts.hpp"

namespace axisgate::simulated {

// What the world sees of a Kinco, and does to it.
void add_kinco(Scene& scene, const std::shared_ptr<void>& owner, KincoDrive& drive) {
  scene.rpm = [owner, &drive](std::int64_t number) { return speed_dec(number, drive.model().encoder_counts); };
  scene.facts["physical"] = count([owner, &drive] { return counts_of(drive.axis().physical()); });
  scene.facts["stores"] = count([owner, &drive] { return drive.stores(); });
  scene.facts["restarts"] = count([owner, &drive] { return drive.restarts(); });
  scene.facts["handled"] = count([owner, &drive] { return drive.writes({0x6040, 0}); });
  scene.facts["enabled"] = count([owner, &drive] { return drive.state() == Cia402State::operation_enabled; });
  scene.facts["cause"] = count([owner, &drive] { return drive.transitions().back().tag; });
  scene.acts["input"] = [owner, &drive](const Row& words) { drive.set_input(std::stoi(words[0]), on(words)); };
  scene.acts["jam"] = [owner, &drive](const Row&) { drive.jam(true); };
  scene.acts["inject"] = [owner, &drive](const Row& words) { drive.inject_fault(std::stoi(words[0]), bits(words[1])); };
  scene.acts["cure"] = [owner, &drive](const Row& words) {
    drive.clear_fault_cause(std::stoi(words[0]), bits(words[1]));
  };
}

void add_leadshine(Scene& scene, const std::shared_ptr<void>& owner, LeadshineDrive& drive) {
  scene.facts["handled"] = count([owner, &drive] { return drive.writes({0x6040, 0}); });
  scene.facts["transitions"] = count([owner, &drive] { return drive.transitions().size(); });
  scene.facts["revolution"] = count([owner, &drive] { return drive.units_per_revolution(); });
  scene.facts["restarts"] = count([owner, &drive] { return drive.restarts(); });
  scene.acts["inject"] = [owner, &drive](const Row& words) { drive.inject_fault(bits(words[0])); };
  scene.acts["cure"] = [owner, &drive](const Row&) { drive.clear_fault_cause(); };
  scene.acts["jam"] = [owner, &drive](const Row&) { drive.jam(true); };
}

// What the world sees of a Keya's two motors, "a.rpm", and does to them.
void add_keya(Scene& scene, const std::shared_ptr<void>& owner, KeyaDrive& drive) {
  for (const KeyaMotorName motor : keya_motors) {
    const std::string it = motor == motor_a ? "a." : "b.";
    scene.facts[it + "enabled"] = count([owner, &drive, motor] { return drive.enabled(motor); });
    scene.facts[it + "faults"] = count([owner, &drive, motor] { return drive.faults(motor); });
    scene.facts[it + "moves"] = count([owner, &drive, motor] { return drive.moves(motor); });
    scene.facts[it + "rpm"] = count([owner, &drive, motor] { return drive.at(motor).rpm(); });
    scene.facts[it + "count"] = count([owner, &drive, motor] { return drive.at(motor).count(); });
    scene.facts[it + "value"] = count([owner, &drive, motor] { return drive.at(motor).value(); });
    scene.facts[it + "current"] = count([owner, &drive, motor] { return drive.at(motor).current(); });
    scene.facts[it + "mode"] = count([owner, &drive, motor] { return static_cast<int>(drive.at(motor).mode()); });
  }
  scene.facts["trips"] = count([owner, &drive] { return drive.trips(); });
  scene.facts["handled"] = count([owner, &drive] { return drive.controls(); });
  scene.facts["restarts"] = count([owner, &drive] { return drive.restarts(); });
  const auto named = [](const std::string& word) { return word == "a" ? motor_a : motor_b; };
  scene.acts["inject"] = [=, &drive](const Row& words) { drive.inject_fault(named(words[0]), bits(words[1])); };
  scene.acts["cure"] = [=, &drive](const Row& words) { drive.clear_fault_cause(named(words[0]), bits(words[1])); };
  scene.acts["show_current"] = [=, &drive](const Row& words) {
    drive.at(named(words[0])).show_current(bits(words[1]));
  };
  scene.acts["count"] = [=, &drive](const Row& words) {
    drive.at(named(words[0])).set_count(static_cast<std::int32_t>(whole(words[1])));
  };
}

// What the world sees of an iD286pro, and does to it.
void add_id286pro(Scene& scene, const std::shared_ptr<void>& owner, Id286pro& drive) {
  scene.facts["physical"] = count([owner, &drive] { return counts_of(drive.axis().physical()); });
  scene.facts["restarts"] = count([owner, &drive] { return drive.restarts(); });
  scene.facts["starts"] = count([owner, &drive] { return drive.starts().size(); });
  scene.facts["cause"] = count([owner, &drive] { return drive.starts().back().tag; });
  scene.facts["internal"] = count([owner, &drive] { return drive.internal_pulses(); });
  scene.facts["saves"] = count([owner, &drive] { return drive.registers().area_saves(); });
  scene.acts["input"] = [owner, &drive](const Row& words) { drive.set_input(std::stoi(words[0]), on(words)); };
  scene.acts["enable"] = [owner, &drive](const Row& words) { drive.set_enable_switch(on(words)); };
  scene.acts["jam"] = [owner, &drive](const Row&) { drive.jam(true); };
  scene.acts["inject"] = [owner, &drive](const Row& words) { drive.inject_fault(bits(words[0]), words.size() == 1); };
  scene.acts["cure"] = [owner, &drive](const Row&) { drive.clear_fault_cause(); };
  // "eeprom 305:3 317:1 unknown 308:1": the writes of each row that is stored, and of those of which it is not known.
  scene.acts["eeprom"] = [owner, &drive](const Row& words) {
    Row found;
    const auto add = [&found](const auto& writes) {
      for (const auto& [row, times] : writes) found.push_back(std::to_string(row) + ':' + std::to_string(times));
    };
    add(drive.registers().stored_writes());
    found.emplace_back("unknown");
    add(drive.registers().unknown_writes());
    EXPECT_EQ(found, words);
  };
  scene.phrases["stands"] = "until 109 = 2";
  scene.phrases["move_on"] = "323 := 2; stands";
}

}  // namespace axisgate::simulated
