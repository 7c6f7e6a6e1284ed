// SPDX-License-Identifier: Apache-2.0
// axisgate-sim, started as a user would by a shell: its pty, its end, and what it leaves alone. What its control socket
// does is in the stories of tests/integration.
#include <gmock/gmock.h>

#include <cstdio>

namespace axisgate::simulated {
namespace {

// What this prints, in a folder of its own that is removed behind it.
std::string shell(const std::string& script) {
  const std::string whole = "cd \"$(mktemp -d)\"; sim=" AXISGATE_SIM_PROGRAM "\n" + script + "\nrm -r \"$PWD\"";
  std::FILE* pipe = ::popen(whole.c_str(), "r");
  std::string text;
  for (int one = std::fgetc(pipe); one != EOF; one = std::fgetc(pipe)) text += static_cast<char>(one);
  ::pclose(pipe);
  return text;
}

TEST(Program, AnswersOnItsPtyHoweverOftenItIsOpenedAndEndsWithoutATrace) {
  const std::string answer = " 01 4b 41 60 00 50 40 00 00 83\n";
  EXPECT_EQ(shell(R"(
    $sim --line "$PWD/lift:jd@1" --control "$PWD/control" >log 2>&1 &
    for i in $(seq 600); do grep -q '^control' log && break; sleep 0.1; done
    for i in 1 2; do
      exec 3<>lift
      printf '\001\100\101\140\000\000\000\000\000\036' >&3
      timeout 60 head -c 10 <&3 | od -An -tx1
      exec 3>&-
    done
    kill -TERM $!; wait $!; echo ended with $?
    rm log; ls)"),
            answer + answer + "ended with 0\n");
}

TEST(Program, SaysWhatIsWrongAndLeavesAFileOfTheUsersAlone) {
  EXPECT_THAT(shell("$sim --line \"$PWD/nowhere/lift:jd@1\" 2>&1; echo ended with $?"),
              testing::AllOf(testing::HasSubstr("does its folder exist?"), testing::EndsWith("ended with 1\n")));
  EXPECT_THAT(shell("echo mine >lift; $sim --line \"$PWD/lift:jd@1\" 2>&1; cat lift"),
              testing::AllOf(testing::HasSubstr("exists and is no link"), testing::EndsWith("mine\n")));
}

}  // namespace
}  // namespace axisgate::simulated
