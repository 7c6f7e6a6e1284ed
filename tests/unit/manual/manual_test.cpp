// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include "gateway/manual/command_tree.hpp"
#include "gateway/manual/completion.hpp"
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

}  // namespace
}  // namespace axisgate::manual
