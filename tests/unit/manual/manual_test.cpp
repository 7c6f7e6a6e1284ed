// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include "gateway/manual/command_tree.hpp"
#include "gateway/manual/completion.hpp"
#include "gateway/manual/configuration_page.hpp"
#include "gateway/manual/generate.hpp"
#include "gateway/manual/manual_page.hpp"

namespace axisgate::manual {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A program with one of each thing that a command line may have.
class Manual : public ::testing::Test {
 protected:
  Manual() {
    app.footer("Example: tool go 5");
    go = app.add_subcommand("go", "Move: there\nand back");
    go->add_option("PLACE", place, "where")->required();
    go->add_option("FILE", files, "lists");
    go->add_option("--speed", speed, "low, middle or high")
        ->check(CLI::IsMember({"low", "middle", "high"}).description(""))
        ->type_name("SPEED")
        ->capture_default_str();
    go->add_option("--turns", turns, "how often")->check(CLI::Range(1, 9))->type_name("N");
    go->add_flag("-q,--quiet", quiet, "say 'nothing'");
    go->add_option("--secret", secret, "hidden")->group("");
    app.add_subcommand("ghost", "hidden")->group("");
  }

  Command tree() { return command_tree(app); }
  Command tree_of_go() { return tree().commands.front(); }
  std::string page() { return manual_page(tree(), "1.2"); }

  CLI::App app{"tool: a tool with a back\\slash", "tool"};
  CLI::App* go = nullptr;
  std::string place;
  std::vector<std::string> files;
  std::string speed = "low";
  int turns = 1;
  bool quiet = false;
  std::string secret;
};

TEST_F(Manual, keeps_the_order_of_the_declarations_and_leaves_out_what_help_hides) {
  EXPECT_EQ(tree().commands.size(), 1U);
  const Command command = tree_of_go();
  ASSERT_EQ(command.options.size(), 4U);
  EXPECT_THAT(command.options[0].names, ElementsAre("-h", "--help"));
  EXPECT_THAT(command.options[1].names, ElementsAre("--speed"));
  EXPECT_THAT(command.options[2].names, ElementsAre("--turns"));
  EXPECT_THAT(command.options[3].names, ElementsAre("-q", "--quiet"));
  for (const std::string& text : {page(), bash_completion(tree()), zsh_completion(tree())}) {
    EXPECT_THAT(text, Not(HasSubstr("secret")));
    EXPECT_THAT(text, Not(HasSubstr("ghost")));
  }
}

TEST_F(Manual, knows_what_an_option_takes) {
  const Command command = tree_of_go();
  EXPECT_EQ(command.options[1].value, "SPEED");
  EXPECT_THAT(command.options[1].words, ElementsAre("low", "middle", "high"));
  EXPECT_EQ(command.options[1].initial, "low");
  EXPECT_EQ(command.options[2].value, "N in [1 - 9]") << "the name for people, and the bounds";
  EXPECT_THAT(command.options[2].words, IsEmpty()) << "no word of its description is a number";
  EXPECT_EQ(command.options[3].value, "");
  EXPECT_EQ(command.options[3].takes, Takes::nothing);
}

TEST_F(Manual, knows_which_arguments_must_be_there_and_which_are_files) {
  const Command command = tree_of_go();
  ASSERT_EQ(command.arguments.size(), 2U);
  EXPECT_TRUE(command.arguments[0].required);
  EXPECT_FALSE(command.arguments[0].repeated);
  EXPECT_EQ(command.arguments[1].takes, Takes::file);
  EXPECT_TRUE(command.arguments[1].repeated);
  EXPECT_THAT(page(), HasSubstr("\\fBtool go\\fR [\\fIOPTIONS\\fR] \\fIPLACE\\fR [\\fIFILE\\fR...]\n"));
}

TEST_F(Manual, a_page_prints_signs_of_roff_as_they_stand) {
  EXPECT_THAT(page(), HasSubstr("\ntool \\- a tool with a back\\eslash\n")) << "and the name once";
  EXPECT_THAT(page(), HasSubstr("say \\(aqnothing\\(aq\n"));
  go->footer(".dotted");
  EXPECT_THAT(page(), HasSubstr("\n\\&.dotted\n"));
}

TEST_F(Manual, a_line_that_opens_with_a_capital_begins_a_line_of_the_page) {
  go->footer("One line that is\nbroken for a terminal.\n   again\nAnother");
  EXPECT_THAT(page(), HasSubstr("One line that is\nbroken for a terminal.\nagain\n.br\nAnother\n"));
}

TEST_F(Manual, a_page_has_a_group_s_copy_of_a_footer_once) {
  CLI::App* const group = app.add_subcommand("group", "More");
  group->add_subcommand("deep", "Deep")->footer("Example: tool group deep");
  EXPECT_EQ(group->get_footer(), app.get_footer()) << "CLI11 copies it";
  const std::string text = page();
  EXPECT_EQ(text.find("Example: tool go 5"), text.rfind("Example: tool go 5"));
  EXPECT_THAT(text, HasSubstr("Example: tool group deep"));
}

TEST_F(Manual, zsh_takes_no_sign_of_a_description_for_its_own) {
  go->add_flag("--odd", quiet, "it's [a] b:c");
  EXPECT_THAT(zsh_completion(tree()), HasSubstr("'--odd[it'\\''s \\[a\\] b\\:c]'"));
  EXPECT_THAT(zsh_completion(tree()), HasSubstr("'go:Move\\: there and back'"));
}

TEST_F(Manual, only_generate_with_a_form_is_meant) {
  const auto asked = [this](std::vector<const char*> words) {
    return generated(app, static_cast<int>(words.size()), words.data()).has_value();
  };
  EXPECT_TRUE(asked({"tool", "--generate", "man"}));
  EXPECT_TRUE(asked({"tool", "--generate", "bash"}));
  EXPECT_TRUE(asked({"tool", "--generate", "zsh"}));
  EXPECT_FALSE(asked({"tool", "--generate", "fish"}));
  EXPECT_FALSE(asked({"tool", "--generate"}));
  EXPECT_FALSE(asked({"tool", "go", "--generate", "man"}));
}

TEST(ConfigurationPage, HasEachKeyWithAllThatTheSchemaSaysOfIt) {
  const std::string page = configuration_page(R"({
    "description": "The whole.", "required": ["buses"],
    "properties": {"$schema": {"type": "string"}, "buses": {"description": "Lines.", "type": "array", "items": {"$ref": "#/definitions/bus"}}},
    "definitions": {"bus": {"properties": {
      "wait_ms": {"description": "So long. 'x'", "type": "integer", "minimum": 1, "maximum": 9, "default": 5, "examples": [3]},
      "limits": {"description": "None.", "type": ["object", "null"], "otherwise": "no limit",
                 "properties": {"speed": {"description": ".dot", "type": "number", "exclusiveMinimum": 0, "maximum": 2, "unit": "rpm",
                                          "examples": [{"a": [1, "b, c"]}]}}},
      "parity": {"description": "Default: as it is.", "enum": ["none", "odd"], "default": "none"}}}}})",
                                              "1.2");
  EXPECT_THAT(page, HasSubstr(".TH GATEWAY.JSON 5 \"\" \"axisgate 1.2\""));
  EXPECT_THAT(page, HasSubstr(".SS \"The file\"\n.TP\n\\fBbuses\\fR (a list)\nLines.\nRequired.\n.SS \"buses[]\"\n"));
  EXPECT_THAT(page,
              HasSubstr("\\fBwait_ms\\fR (a whole number 1 to 9, ms)\nSo long. \\(aqx\\(aq\nDefault: 5.\n.br\nExample: "
                        "\\fB\"wait_ms\": 3\\fR\n"));
  EXPECT_THAT(page, HasSubstr("\\fBlimits\\fR (an object, or null)\nNone.\nWithout it: no limit.\n"));
  EXPECT_THAT(page, HasSubstr(".SS \"buses[].limits\"\n.TP\n\\fBspeed\\fR (a number above 0 to 2, rpm)\n\\&.dot\n"));
  EXPECT_THAT(page, HasSubstr("\\fB\"speed\": {\"a\": [1, \"b, c\"]}\\fR\n"));
  EXPECT_THAT(page, HasSubstr("(\"none\", \"odd\")\nDefault: as it is.\n.")) << "said once";
  EXPECT_THAT(page, Not(HasSubstr("schema\\fR")));
}

}  // namespace
}  // namespace axisgate::manual
