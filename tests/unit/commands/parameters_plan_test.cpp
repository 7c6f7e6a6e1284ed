// SPDX-License-Identifier: Apache-2.0
// Which objects of a drive are settings, what a file of them is worth, and what a restore would write: against a drive
// of some objects written down here.
#include <gmock/gmock.h>

#include <array>
#include <nlohmann/json.hpp>

#include "gateway/commands/parameters/plan/parameter_plan.hpp"
#include "gateway/model/real32.hpp"

namespace axisgate::commands {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class ParametersPlan : public ::testing::Test {
 protected:
  enum : model::ObjectId {
    controlword,
    gain,
    current,
    target,
    function,
    save,
    heartbeat,
    node,
    own_limit,
    command_speed
  };

  static model::ObjectDef object(const char* name, std::uint16_t index, std::uint8_t size = 2) {
    model::ObjectDef out;
    out.name = name;
    out.address = {index, 0};
    out.size = size;
    out.writable = true;
    return out;
  }

  ParametersPlan() {
    model_.protocol = "canopen";
    model_.profile = "acme";
    model_.objects = {object("controlword", 0x6040),  object("gain", 0x60FB, 4),       object("max_current", 0x6073),
                      object("target", 0x607A, 4),    object("din1_function", 0x2010), object("save", 0x2FF0),
                      object("heartbeat", 0x2F00),    object("node_id", 0x2F01, 1),    object("limit", 0x607D, 4),
                      object("command_speed", 0x2020)};
    model_.objects[save].trigger = true;
    model_.objects[own_limit].is_signed = true;
    model_.objects[current].printed = {0, 2000};
    model_.objects[current].nvm = model::Nvm::yes;
    model_.axes.resize(1);
    model_.axes[0].number = 1;
    model_.axes[0].binding_of.fill(-1);
    model_.axes[0].controlword = controlword;
    model::Binding& binding = model_.axes[0].bindings.emplace_back();
    binding.quantity = Quantity::target_position;
    binding.object = target;
    binding.writable = true;
    model::Step step;
    step.object = command_speed;
    model_.axes[0].commands[static_cast<std::size_t>(Command::run_velocity)].emplace();
    model_.axes[0].commands[static_cast<std::size_t>(Command::run_velocity)]->steps.push_back(step);
    model_.setup = {{heartbeat, 100, ""}};
    model::Check check;
    check.name = "local_control";
    check.text = "DIN1 enables the drive";
    check.bad = {function, 0, model::Condition::Test::equals, {1}};
    model_.checks = {check};
  }
  std::vector<Parameter> parameters(const char* eds_text = nullptr) {
    if (eds_text == nullptr) return parameters_of(model_, 0, nullptr);
    const profile::Eds eds = profile::parse_eds(eds_text);
    return parameters_of(model_, 0, &eds);
  }
  /// "": it may be written; "none": it is not there.
  std::string never(std::uint16_t index, const char* eds = nullptr) {
    for (const Parameter& parameter : parameters(eds))
      if (parameter.object.address.index == index) return parameter.never;
    return "none";
  }
  ParameterFile file(std::vector<SavedParameter> objects) {
    ParameterFile out;
    out.drive.profile = "acme";
    out.drive.protocol = "canopen";
    out.objects = std::move(objects);
    return out;
  }
  /// The drive holds 7 everywhere.
  std::vector<Difference> against(std::vector<SavedParameter> objects) {
    const auto all = parameters();
    return differences(model_, all, Readings(all.size(), Reading{7, {}}), file(std::move(objects)));
  }
  model::DriveModel model_;
};

SavedParameter entry(std::uint16_t index, const char* name, const char* type, std::optional<std::int64_t> value) {
  return {{index, 0}, name, type, {value, value ? "" : "refused"}};
}

TEST_F(ParametersPlan, SettingsMayBeWrittenAndNothingThatMovesStartsOrLosesTheDrive) {
  for (const std::uint16_t index : std::to_array<std::uint16_t>({0x60FB, 0x6073, 0x2010, 0x607D}))
    EXPECT_EQ(never(index), "") << index;
  for (const std::uint16_t index : std::to_array<std::uint16_t>({0x6040, 0x607A, 0x2020}))
    EXPECT_THAT(never(index), HasSubstr("operation")) << index;
  EXPECT_THAT(never(0x2FF0), HasSubstr("starts something"));
  EXPECT_THAT(never(0x2F00), HasSubstr("gateway sets it at each start"));
  EXPECT_THAT(never(0x2F01), HasSubstr("lose the drive"));
  model_.objects[gain].mailbox_reads_only = true;
  EXPECT_THAT(never(0x60FB), HasSubstr("another name"));
}

TEST_F(ParametersPlan, WhatAProfileOnlyNamesIsJudgedByItsName) {
  for (const char* name : {"A.target_position", "output_control", "jog_speed", "simulated_in1", "register_311"}) {
    model_.objects[gain].name = name;
    EXPECT_THAT(never(0x60FB), Not(IsEmpty())) << name;
  }
  model_.objects[gain].name = "homing_speed";
  EXPECT_EQ(never(0x60FB), "");
}

TEST_F(ParametersPlan, ReadOnlyOtherAxesAndWhatIsNotInTheDriveIsLeftOut) {
  model_.objects[gain].writable = false;
  model_.objects[current].emulated = true;
  model_.objects[own_limit].slot = 1;
  for (const std::uint16_t index : std::to_array<std::uint16_t>({0x60FB, 0x6073, 0x607D}))
    EXPECT_EQ(never(index), "none") << index;
}

TEST_F(ParametersPlan, OfTwoNamesOfOnePlaceTheStricterCounts) {
  model_.axes[0].bindings[0].object = static_cast<model::ObjectId>(model_.objects.size());
  model_.objects.push_back(object("second_name", 0x607A, 4));
  EXPECT_THAT(never(0x607A), HasSubstr("operation"));
}

// What no profile has named may be anything: in doubt it is not written.
TEST_F(ParametersPlan, OfAnEdsOnlyWhatCanBeNoCommandIsWritten) {
  const std::string head = "[DeviceInfo]\nProductName=x\n";
  const auto entry_of = [&](const char* name, const char* index, const char* more = "") {
    return head + "[" + index + "]\nParameterName=" + name + "\nObjectType=0x7\nDataType=0x0006\nAccessType=rw\n" +
           more;
  };
  const auto of = [&](std::uint16_t index, const std::string& text) { return never(index, text.c_str()); };
  EXPECT_EQ(of(0x3000, entry_of("Speed loop gain", "3000", "LowLimit=1\nHighLimit=9\n")), "");
  for (const char* name : {"Jog speed", "Start homing", "Reset node", "Restore factory", "Control word", "Target speed",
                           "Auto tuning", "Enable drive", "Digital output", "Brake"})
    EXPECT_THAT(of(0x3000, entry_of(name, "3000")), Not(IsEmpty())) << name;
  for (const char* name : {"Node ID", "Baud rate", "CAN bitrate", "RS485 station", "Password"})
    EXPECT_THAT(of(0x3000, entry_of(name, "3000")), HasSubstr("lose the drive")) << name;
  EXPECT_THAT(of(0x3000, entry_of("Gain", "3000", "PDOMapping=1\n")), HasSubstr("process data"));
  EXPECT_THAT(of(0x1010, entry_of("Anything", "1010")), HasSubstr("communication"));
  EXPECT_THAT(of(0x60FF, entry_of("Anything", "60FF")), HasSubstr("operation"));
  EXPECT_EQ(of(0x68FF, entry_of("Anything", "68FF")), "none") << "of the next axis";
  EXPECT_EQ(of(0x60FB, entry_of("Anything", "60FB")), "") << "the profile knows it";
  EXPECT_THAT(of(0x3000, head + "[3000]\nParameterName=Text\nObjectType=7\nDataType=0x0009\nAccessType=rw\n"),
              HasSubstr("text or a long number"));
  EXPECT_EQ(of(0x3000, head + "[3000]\nParameterName=Gain\nObjectType=7\nDataType=6\nAccessType=ro\n"), "none");
  model_.protocol = "modbus-rtu";
  EXPECT_FALSE(takes_eds(model_));
}

TEST_F(ParametersPlan, WhatIsSavedIsReadAgainAsTheSame) {
  ParameterFile before = file({entry(0x2010, "din1_function", "u16", 1), entry(0x607D, "limit", "i32", -5),
                               entry(0x60FB, "gain", "f32", model::real_of_bits(0xBDCCCCCDU)),
                               entry(0x6073, "max_current", "u16", std::nullopt)});
  before.axis = 3;
  before.axis_name = "lift \"1\"";
  before.at = "2026-01-01T00:00:00Z";
  before.drive.identity = {0x300, 1, std::nullopt, 0xFFFFFFFF};
  before.drive.firmware = "V1.2";
  const std::string text = json_text(before);
  const auto read = parse_parameter_file(text);
  ASSERT_TRUE(std::holds_alternative<ParameterFile>(read)) << text;
  EXPECT_EQ(json_text(std::get<ParameterFile>(read)), text);
  EXPECT_EQ(std::get<ParameterFile>(read).objects[2].reading.number, model::real_of_bits(0xBDCCCCCDU));
}

TEST_F(ParametersPlan, EachMistakeOfAnEditedFileIsNamedWithItsPlace) {
  const nlohmann::json good = nlohmann::json::parse(json_text(file({entry(0x2010, "f", "u16", 1)})));
  const auto first = [&](const char* pointer, const nlohmann::json& value) {
    nlohmann::json wrong = good;
    wrong[nlohmann::json::json_pointer(pointer)] = value;
    const auto read = parse_parameter_file(wrong.dump());
    const auto* faults = std::get_if<std::vector<profile::SchemaFault>>(&read);
    return faults == nullptr ? std::string("none") : faults->front().pointer + ": " + faults->front().message;
  };
  EXPECT_EQ(first("/objects/0/value", 2), "none");
  EXPECT_EQ(first("/objects/0/value", 65536), "/objects/0/value: must be a whole number of 0 to 65535");
  EXPECT_THAT(first("/objects/0/value", -1), HasSubstr("must be a whole number of 0 to"));
  EXPECT_THAT(first("/objects/0/value", "1"), HasSubstr("must be a whole number"));
  EXPECT_THAT(first("/objects/0/type", "u24"), HasSubstr("/objects/0/type: must be one of u8"));
  EXPECT_THAT(first("/objects/0/at", "2010"), HasSubstr("/objects/0/at: must be index and sub-index"));
  EXPECT_THAT(first("/objects/0/at", "20103.0"), HasSubstr("must be index and sub-index"));
  EXPECT_THAT(first("/objects/1", good["/objects/0"_json_pointer]),
              HasSubstr("/objects/1/at: stands in the file twice"));
  EXPECT_THAT(first("/parameters", 2), HasSubstr("/parameters: must be 1"));
  EXPECT_THAT(first("/profile", ""), HasSubstr("/profile: is missing"));
  EXPECT_THAT(first("/objects", nlohmann::json::array()), HasSubstr("/objects: there are none"));
  EXPECT_THAT(first("/identity/vendor", "x"), HasSubstr("/identity/vendor: must be a number"));
  const auto no_json = parse_parameter_file("{,");
  EXPECT_TRUE(std::holds_alternative<std::vector<profile::SchemaFault>>(no_json));
}

TEST_F(ParametersPlan, WhatDiffersIsWrittenAndNothingElse) {
  const auto found = against({entry(0x6073, "max_current", "u16", 1500), entry(0x60FB, "gain", "u32", 7)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].text, "max_current (6073.00): 1500 in the file, 7 in the drive");
  EXPECT_EQ(found[0].write, 1500);
  EXPECT_EQ(found[0].now, 7);
  EXPECT_TRUE(any_counts(found));
  EXPECT_FALSE(any_counts(against({entry(0x60FB, "gain", "u32", 7)})));
}

TEST_F(ParametersPlan, WhatIsNotWrittenSaysWhy) {
  const auto why = [&](SavedParameter saved) {
    const auto found = against({std::move(saved)});
    return found.empty() || found[0].write ? std::string("it is written") : found[0].not_written;
  };
  EXPECT_THAT(why(entry(0x6073, "max_current", "u16", 2001)), HasSubstr("2001 is outside its range of 0 to 2000"));
  EXPECT_THAT(why(entry(0x6073, "max_current", "u32", 1)), HasSubstr("the file has it as u32, and here it is u16"));
  EXPECT_THAT(why(entry(0x6073, "max_current", "u16", std::nullopt)), HasSubstr("was not read"));
  EXPECT_THAT(why(entry(0x3333, "other", "u16", 1)), HasSubstr("neither the profile nor an EDS"));
  EXPECT_THAT(why(entry(0x2010, "din1_function", "u16", 1)), HasSubstr("DIN1 enables the drive"));
  EXPECT_EQ(why(entry(0x2010, "din1_function", "u16", 2)), "it is written");
  EXPECT_THAT(why(entry(0x607A, "target", "u32", 1)), HasSubstr("operation"));
  EXPECT_FALSE(any_counts(against({entry(0x607A, "target", "u32", 1)}))) << "it is another one from hour to hour";
  EXPECT_TRUE(any_counts(against({entry(0x2F01, "node_id", "u8", 1)}))) << "a person has to look at that";
}

TEST_F(ParametersPlan, WhatCannotBeReadNowIsNotWritten) {
  const auto all = parameters();
  const auto found = differences(model_, all, Readings(all.size(), Reading{{}, "refused"}),
                                 file({entry(0x6073, "max_current", "u16", 1)}));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].write, std::nullopt);
  EXPECT_THAT(found[0].not_written, HasSubstr("cannot be read now"));
}

TEST_F(ParametersPlan, ADriveOfAnotherTypeIsRefusedAndAnotherSerialNumberIsNot) {
  DriveFacts saved{"acme", "Acme", "canopen", 1, {0x300, 7, 2, 11}, "V1"};
  DriveFacts now = saved;
  now.identity[3] = 12;
  EXPECT_EQ(objection(saved, now), "");
  EXPECT_THAT(remarks(saved, now), ElementsAre(AllOf(HasSubstr("0xb"), HasSubstr("0xc"))));
  now.identity[2] = 3;
  EXPECT_EQ(objection(saved, now), "");
  EXPECT_EQ(remarks(saved, now).size(), 2U) << "another firmware";
  for (const std::size_t i : {0U, 1U}) {
    DriveFacts other = saved;
    other.identity[i] = 99;
    EXPECT_THAT(objection(saved, other), HasSubstr("0x63"));
    other.identity[i] = std::nullopt;
    EXPECT_THAT(objection(saved, other), HasSubstr("not known")) << "it does not say what it is";
  }
  DriveFacts other = saved;
  other.profile = "other";
  EXPECT_THAT(objection(saved, other), HasSubstr("profile acme, and this one has other"));
  other = saved;
  other.protocol = "modbus-rtu";
  EXPECT_THAT(objection(saved, other), HasSubstr("canopen"));
}

TEST_F(ParametersPlan, TheMemoryOfTheDriveIsSparedAndThatIsSaidBefore) {
  std::vector<Parameter> all(13, Parameter{model_.objects[current]});
  std::vector<Difference> found(13);
  for (std::size_t i = 0; i < found.size(); ++i) {
    found[i].place = i;
    found[i].write = 1;
  }
  EXPECT_THAT(cost(model_, 0, all, found), ElementsAre(HasSubstr("13 of 13"), HasSubstr("takes 3 minutes")));
  found.resize(10);
  EXPECT_THAT(cost(model_, 0, all, found), ElementsAre(HasSubstr("10 of 10")));
  all.assign(13, Parameter{model_.objects[gain]});
  EXPECT_THAT(cost(model_, 0, all, found), ElementsAre(HasSubstr("no command that stores them")));
  model_.axes[0].supported_commands = 1U << static_cast<unsigned>(Command::save_parameters);
  EXPECT_THAT(cost(model_, 0, all, found), ElementsAre(HasSubstr("stores them, once")));
}

TEST_F(ParametersPlan, AnAnswerIsANumberOrAReason) {
  const auto all = parameters();
  const Parameter& limit =
      *std::ranges::find(all, std::uint16_t{0x607D}, [](const Parameter& p) { return p.object.address.index; });
  BatchResult answer;
  answer.object_data = 0xFFFFFFFE;
  answer.object_size = 4;
  EXPECT_EQ(reading_of(model_, limit, answer).number, -2);
  answer.object_size = 2;
  EXPECT_THAT(reading_of(model_, limit, answer).why, HasSubstr("answers 2 bytes, and 4 were expected"));
  BatchResult refused;
  refused.outcome = {Errc::refused_by_drive, 0x06020000};
  refused.abort_code = 0x06020000;
  EXPECT_THAT(reading_of(model_, limit, refused).why, AllOf(HasSubstr("0x06020000"), HasSubstr("no such object")));
  EXPECT_EQ(after(refused), After::next) << "the others go on";
  EXPECT_EQ(after({{Errc::busy, 0}}), After::again);
  for (const Errc gone : {Errc::timed_out, Errc::offline, Errc::link_lost}) EXPECT_EQ(after({{gone, 0}}), After::end);
}

TEST_F(ParametersPlan, AWriteIsGoodOnceTheDriveHoldsIt) {
  const Parameter parameter{model_.objects[gain]};
  const BatchResult ok;
  EXPECT_TRUE(written(parameter, 5, ok, Reading{5, {}}).held);
  const Written other = written(parameter, 5, ok, Reading{4, {}});
  EXPECT_FALSE(other.held || other.ends || other.try_later);
  EXPECT_EQ(other.text, "the drive holds 4, although 5 was written");
  EXPECT_FALSE(written(parameter, 5, ok, Reading{{}, "refused"}).held) << "it cannot be read back";
  EXPECT_TRUE(written(parameter, 5, ok, std::nullopt).ends);
  BatchResult refused;
  refused.outcome = {Errc::refused_by_drive, 0x06090030};
  refused.abort_code = 0x06090030;
  EXPECT_TRUE(written(parameter, 5, refused, std::nullopt).try_later) << "its bounds may be other parameters";
  EXPECT_THAT(written(parameter, 5, refused, std::nullopt).text, HasSubstr("0x06090030"));
  const Written gone = written(parameter, 5, {{Errc::timed_out, 0}}, std::nullopt);
  EXPECT_TRUE(gone.ends);
  EXPECT_THAT(gone.text, HasSubstr("is not known"));
}

TEST_F(ParametersPlan, WhatChangedSinceTheQuestionIsNotWritten) {
  const Parameter parameter{model_.objects[gain]};
  EXPECT_FALSE(changed(parameter, 5, Reading{5, {}}));
  EXPECT_EQ(changed(parameter, 5, Reading{6, {}})->text, "not written: it holds 6 now, and held 5 when you were asked");
  EXPECT_FALSE(changed(parameter, 5, Reading{6, {}})->ends);
  EXPECT_FALSE(changed(parameter, 5, Reading{{}, "refused"})->ends);
  EXPECT_TRUE(changed(parameter, 5, std::nullopt)->ends);
}

TEST_F(ParametersPlan, ANegativeNumberIsWrittenInItsWidth) {
  EXPECT_EQ(write_request({model_.objects[own_limit]}, -2).data, 0xFFFFFFFEU);
  model_.objects[current].is_signed = true;
  const ObjectRequest request = write_request({model_.objects[current]}, -2);
  EXPECT_EQ(request.data, 0xFFFEU);
  EXPECT_EQ(request.size, 2);
  EXPECT_TRUE(request.write);
}

TEST_F(ParametersPlan, HowLongItTakesIsToldByWhatItTook) {
  EXPECT_EQ(progress_text(500, 2000, std::chrono::seconds(5)), "read 500 of 2000, about 15 s to go");
  EXPECT_EQ(progress_text(0, 2000, std::chrono::seconds(5)), "read 0 of 2000, about 0 s to go");
}

}  // namespace
}  // namespace axisgate::commands
