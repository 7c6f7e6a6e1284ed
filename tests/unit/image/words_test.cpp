// SPDX-License-Identifier: Apache-2.0
#include "gateway/core/words.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "gateway/core/error.hpp"
#include "gateway/image/process_image.hpp"
#include "gateway/listing/map_page.hpp"
#include "tests/places.hpp"

namespace axisgate {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> names(const std::vector<const Word*>& found) {
  std::vector<std::string> out;
  for (const Word* word : found) out.push_back(std::string(title(word->kind)) + ": " + std::string(word->name));
  return out;
}

TEST(Words, AreInOrderAndUniqueAndTroubleHasARemedyOrACause) {
  std::set<std::pair<WordKind, std::string_view>> seen;
  const Word* before = nullptr;
  for (const Word& word : words()) {
    EXPECT_FALSE(word.name.empty());
    EXPECT_FALSE(word.meaning.empty()) << word.name;
    EXPECT_TRUE(seen.insert({word.kind, word.name}).second) << word.name;
    if (before != nullptr) {
      EXPECT_LT(std::pair(before->kind, before->number), std::pair(word.kind, word.number)) << word.name;
    }
    if (word.kind == WordKind::axis_alarm || word.kind == WordKind::gateway_alarm) {
      EXPECT_FALSE(word.causes.empty() && word.remedy.empty() && word.number != 9) << word.name;
    }
    before = &word;
  }
}

// Whatever a client can be shown has a name.
TEST(Words, CoverEverythingThatIsShown) {
  for (int code = 0; code < kErrcCount; ++code) {
    const auto exception = static_cast<std::uint32_t>(modbus_exception(static_cast<Errc>(code)));
    EXPECT_TRUE(exception == 0 || find_word(WordKind::exception, exception) != nullptr) << code;
    EXPECT_NE(find_word(WordKind::result, dds_result(static_cast<Errc>(code))), nullptr) << code;
    const auto result = static_cast<std::uint32_t>(command_result(static_cast<Errc>(code)));
    EXPECT_NE(find_word(WordKind::result, result), nullptr) << code;
  }
  for (unsigned alarm = 0; alarm < kAxisAlarmCount; ++alarm) EXPECT_NE(text(static_cast<AxisAlarm>(alarm)), "?");
  for (unsigned state = 0; state <= static_cast<unsigned>(AxisState::unknown); ++state)
    EXPECT_NE(text(static_cast<AxisState>(state)), "?");
  for (unsigned state = 0; state <= static_cast<unsigned>(LinkState::link_down); ++state)
    EXPECT_NE(text(static_cast<LinkState>(state)), "?");
  EXPECT_NE(find_word(WordKind::gateway_alarm, static_cast<std::uint32_t>(GatewayAlarm::listener_down)), nullptr);
}

// A register's meaning calls a number what `top`, the log and `axisgate explain` call it.
TEST(Words, AreWhatTheRegisterMapTells) {
  using enum WordKind;
  EXPECT_EQ(list_of(motion_state), "0 none, 1 active, 2 completed, 3 aborted, 4 failed");
  EXPECT_THAT(list_of(result), testing::EndsWith("11 not_reached")) << "those of DDS are in no register";
  EXPECT_THAT(list_of(gateway_alarm), testing::StartsWith("bit 0 axis offline, 1 bus down, "));
  const std::string page = listing::register_map_page();
  for (const WordKind kind :
       {axis_state, motion_state, link_state, mode, axis_alarm, gateway_state, gateway_alarm, result})
    EXPECT_THAT(page, testing::HasSubstr(list_of(kind))) << title(kind);
}

TEST(Words, AreFoundAsSomebodyTypesThem) {
  EXPECT_THAT(names(look_up("Stop-Latched")), ElementsAre("axis alarm: stop_latched"));
  EXPECT_THAT(names(look_up("result 9")), ElementsAre("result: state unsuitable"));
  EXPECT_THAT(names(look_up("alarm 7")), ElementsAre("axis alarm: stop_latched", "gateway alarm: DDS process down"));
  EXPECT_THAT(names(look_up("exception 0x0B")), ElementsAre("exception: gateway target failed"));
  EXPECT_THAT(names(look_up("0x06010002")), ElementsAre("abort code: read only"));
  EXPECT_THAT(names(look_up("11")), ElementsAre("axis alarm: stop_options", "gateway alarm: EEPROM write budget",
                                                "result: not_reached", "exception: gateway target failed"));
  EXPECT_THAT(names(look_up("unsuit")), ElementsAre("result: state unsuitable")) << "a part is enough";
  EXPECT_THAT(look_up("no such thing"), IsEmpty());
  EXPECT_THAT(look_up(""), IsEmpty());
  EXPECT_THAT(look_up("99999999999"), IsEmpty());
}

TEST(Words, NameAnErrorByItsClassWhereTheyHaveNoOther) {
  EXPECT_EQ(find_error(0x8130)->name, "no contact");
  EXPECT_EQ(find_error(0x7328)->name, "sensor");
  EXPECT_EQ(find_error(0x4999)->name, "temperature");
  EXPECT_EQ(find_error(0), nullptr);
}

TEST(Words, NameTheBitsThatAreSet) {
  EXPECT_EQ(names_of_bits(WordKind::axis_alarm, 1U << 5 | 1U << 7 | 1U << 31), "not_homed, stop_latched, bit 31");
  EXPECT_EQ(names_of_bits(WordKind::axis_alarm, 0), "");
  EXPECT_EQ(name_of(WordKind::axis_state, 200), "?");
}

TEST(Words, NameTheAlarmsThatStandAgainstAnEnableAndWhatHelps) {
  EXPECT_EQ(against_enable(1U << 5 | 1U << 7, 3), "") << "not_homed, stop_latched: an enable passes";
  EXPECT_EQ(against_enable(1U << 3 | 1U << 5, 3),
            "alarm local_control: the drive obeys its own inputs or keypad and ignores the bus; axisgate commission "
            "CONFIG 3 shows and changes it");
  for (const std::uint32_t alarm : {2U, 12U}) EXPECT_NE(against_enable(1U << alarm, 3), "") << alarm;
}

/// AXISGATE_WRITE_PAGES=1 ctest --test-dir BUILD -R Page writes them anew.
void expect_page(const char* page, const std::string& made) {
  const std::string path = test::source_path(page);
  if (std::getenv("AXISGATE_WRITE_PAGES") != nullptr) std::ofstream(path) << made;
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), made) << page << " is not what the table says";
}

TEST(TroubleshootingPage, IsTheOneInDocs) { expect_page("docs/troubleshooting.md", troubleshooting_page()); }

TEST(GlossaryPage, IsTheOneInDocs) { expect_page("docs/glossary.md", glossary_page()); }

TEST(GlossaryPage, SaysOfEachWordWhatItIsWhatIsSeenAndWhatToDo) {
  int terms = 0;
  for (const Word& word : words()) {
    if (word.kind != WordKind::term) continue;
    ++terms;
    EXPECT_FALSE(word.meaning.empty() || word.causes.empty() || word.remedy.empty()) << word.name;
    EXPECT_THAT(glossary_page(), testing::HasSubstr("\n## " + std::string(word.name) + "\n\n*" +
                                                    std::string(word.name) + "* is " + std::string(word.meaning)));
    EXPECT_THAT(troubleshooting_page(), testing::Not(testing::HasSubstr(word.meaning))) << word.name;
  }
  EXPECT_EQ(terms, 11);
}

}  // namespace
}  // namespace axisgate
