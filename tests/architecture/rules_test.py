#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Each rule finds what it forbids, and lets the allowed pass: a rule that never fires guards nothing."""
import tempfile
import unittest
from pathlib import Path

import rules
from class_sizes import FEWEST_FUNCTIONS, MOST_FIELDS, MOST_FUNCTIONS, class_sizes, classes_of
from proofs import FAULTS, RULES_AND_DECISIONS

HEADER = "// What it is.\n// Promises this.\n// Never that.\n#pragma once\n"


class Rules(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def breaches(self, rule):
        return list(rules.RULES[rule](self.root))

    def assert_breach(self, rule, place):
        self.assertEqual([breach.split(": ")[0] for breach in self.breaches(rule)], [place])

    def test_an_arrow_against_the_direction_is_found(self):
        self.write("gateway/image/a.cpp", '#include "gateway/image/a.hpp"\n#include "gateway/model/model.hpp"\n')
        self.assert_breach("arrows", "gateway/image/a.cpp:2")

    def test_an_arrow_in_the_direction_is_let_pass(self):
        self.write("gateway/upstream/modbus_tcp/a.cpp", '#include "gateway/image/a.hpp"\n#include <vector>\n')
        self.write("gateway/commands/b.cpp", '#include "adapters/serial/port.hpp"\n')
        self.write("adapters/kinco/c.cpp", '#include "adapters/bus/wire.hpp"\n')
        self.assertEqual(self.breaches("arrows"), [])

    def library(self, folder, name, depends=""):
        self.write(f"{folder}/CMakeLists.txt", f"axisgate_library({name}\n  SOURCES a.cpp{depends and f' DEPENDS {depends}'}\n  LIBRARIES fmt::fmt)\n")

    def test_a_header_of_a_library_that_is_not_named_is_found(self):
        self.library("gateway/drive/plan", "axisgate_drive_plan", "axisgate_drive_motion")
        self.library("gateway/drive/motion", "axisgate_drive_motion")
        self.library("gateway/drive/axis", "axisgate_drive_axis")
        self.write("gateway/drive/plan/a.cpp", '#include "gateway/drive/motion/b.hpp"\n#include "gateway/drive/axis/c.hpp"\n')
        self.assert_breach("arrows", "gateway/drive/plan/a.cpp:2")

    def test_a_circle_of_libraries_is_found(self):
        self.library("gateway/drive/a", "axisgate_a", "axisgate_b")
        self.library("gateway/drive/b", "axisgate_b", "axisgate_a")
        self.assert_breach("arrows", "gateway/drive/a/CMakeLists.txt:1")

    def test_a_second_library_in_one_folder_is_found(self):
        self.write("adapters/can/CMakeLists.txt", "axisgate_library(axisgate_can SOURCES a.cpp)\naxisgate_library(axisgate_can_link SOURCES b.cpp)\n")
        self.assert_breach("arrows", "adapters/can/CMakeLists.txt:1")

    def test_one_adapter_must_not_know_another(self):
        self.write("adapters/kinco/a.cpp", '#include "adapters/serial/port.hpp"\n')
        self.assert_breach("arrows", "adapters/kinco/a.cpp:1")

    def test_a_simulated_drive_must_not_know_the_gateway(self):
        self.write("tests/simulated/a.cpp", '#include "adapters/kinco/codec.hpp"\n')
        self.assert_breach("arrows", "tests/simulated/a.cpp:1")

    def test_a_folder_without_a_rule_is_found(self):
        self.write("gateway/new/a.cpp", '#include "gateway/core/error.hpp"\n')
        self.assert_breach("arrows", "gateway/new/a.cpp:1")

    def test_a_namespace_that_is_not_named_after_its_room_is_found(self):
        self.write("gateway/config/a.cpp", "namespace axisgate::app {\n")
        self.write("gateway/config/b.cpp", "namespace axisgate::config::adapter {\n")
        self.write("adapters/can/link/c.cpp", "namespace axisgate::can {\n")
        self.assert_breach("namespaces", "gateway/config/a.cpp:1")

    def test_a_header_that_only_one_place_may_know_is_found(self):
        self.write("gateway/drive/a.cpp", "#include <linux/can/raw.h>\n")
        self.assert_breach("one_place", "gateway/drive/a.cpp:1")

    def test_io_in_a_deciding_file_is_found_and_a_shell_is_let_pass(self):
        self.write("adapters/bus/arbiter.cpp", "int x;\n#include <boost/asio/post.hpp>\n")
        self.write("gateway/upstream/modbus_tcp/server/server.cpp", "#include <boost/asio/post.hpp>\n")
        self.write("adapters/can/link/raw_socket.cpp", "#include <sys/socket.h>\n")
        self.assert_breach("deciding", "adapters/bus/arbiter.cpp:2")

    def test_a_clock_in_a_deciding_file_is_found(self):
        self.write("gateway/drive/motion/motion.cpp", "auto now = std::chrono::steady_clock::now();\n")
        self.assert_breach("deciding", "gateway/drive/motion/motion.cpp:1")

    def test_a_header_without_its_three_sentences_is_found(self):
        self.write("gateway/core/good.hpp", HEADER)
        self.write("gateway/core/bad.hpp", "#pragma once\n")
        self.assert_breach("headers", "gateway/core/bad.hpp:1")

    def test_a_header_with_all_of_json_is_found(self):
        self.write("gateway/core/bad.hpp", HEADER + "#include <nlohmann/json.hpp>\n")
        self.assert_breach("headers", "gateway/core/bad.hpp:1")

    def test_a_file_that_is_too_long_is_found(self):
        self.write("gateway/core/long.cpp", "\n" * 401)
        self.write("gateway/core/longest.cpp", "\n" * 400)
        self.assert_breach("lengths", "gateway/core/long.cpp:401")

    def test_a_leftover_is_found(self):
        self.write("gateway/core/a.cpp", "// TO" "DO: later\n")
        self.assert_breach("words", "gateway/core/a.cpp:1")

    def test_a_private_word_in_a_comment_and_in_a_name_is_found(self):
        self.write("gateway/core/a.cpp", "int x;  // until the fence is answered\n")
        self.write("gateway/core/b.cpp", "void on_notice();\n")
        self.write("gateway/drive/c.cpp", "void take(const Group& batch);\n")
        self.write("adapters/bus/d.hpp", "/// Ends an order.\n")
        self.assertEqual([breach.split(": ")[0] for breach in self.breaches("field_words")],
                         ["adapters/bus/d.hpp:1", "gateway/core/a.cpp:1", "gateway/core/b.cpp:1", "gateway/drive/c.cpp:1"])

    def test_a_word_that_says_nothing_is_found_in_a_header(self):
        self.write("gateway/core/a.hpp", "/// Begins anew.\nvoid take_unasked();\nclass HandPlan;\nbool told_up_;\n/// What it was told.\n")
        self.write("gateway/core/let_go.hpp", "")
        self.assertEqual([breach.split(": ")[0] for breach in self.breaches("field_words")],
                         [f"gateway/core/a.hpp:{line}" for line in range(1, 6)] + ["gateway/core/let_go.hpp:1"])

    def test_such_a_word_is_let_pass_in_the_log_in_a_source_and_in_another_word(self):
        self.write("gateway/core/log.hpp", "Instant told;  // when it was told\n")
        self.write("gateway/core/a.cpp", "bool anew;\n")
        self.write("gateway/core/a.hpp", "void hand_over();  // a handshake with a handler\nint native_handle; bool is_write_function();\n")
        self.assertEqual(self.breaches("field_words"), [])

    def test_a_private_word_on_a_page_is_found(self):
        self.write("docs/a.md", "A drive.\nLate replies meet a fence.\n")
        self.assert_breach("field_words", "docs/a.md:2")

    def test_words_in_quotes_and_words_of_another_meaning_are_let_pass(self):
        self.write("gateway/drive/a.cpp", 'read("fence"); word_order(in_order, interface, surface, mutex);\n')
        self.write("docs/a.md", "The key `fence` has another name now.\n")
        self.write("adapters/serial/b.cpp", "std::string group;  // in the order of the members of a group\n")
        self.assertEqual(self.breaches("field_words"), [])

    ARCHITECTURE = """## How it is built\n1. **Pure.**\n2. **One thread.**\n## Promises\n| P2 | fast |\n## What comments cite
| 3 | Modbus-TCP | | |\n| 3.3 | writes | Edges | |\n| 3.4 | motion | Owed stops | |\n| 7 | built | | |\n| 8 | promises | | |\n"""

    def test_a_cite_of_what_is_not_there_is_found(self):
        self.write("ARCHITECTURE.md", self.ARCHITECTURE)
        self.write("gateway/a.cpp", "int x;\n// As Design-2 A10 has it.\n// A8: an orphan\n")
        self.write("gateway/b.cpp", "// A stop (design 3.4, \"Stops\").\n// By design 3.4 Owed\n// halts.\n")
        self.write("gateway/c.cpp", "// Design 3.4 Owed stops, 3.3 Jog.\n// (design 3.6)\n// (design 7.2)\n// (design 7, points 2 and 3)\n")
        self.write("tests/bench/d.cpp", 'f("P3: late");  // P2\n')
        self.write("tests/model/e.cpp", "int y;  // 3.3 Zeros: \"leave as it is\"\n")
        self.write("tests/unit/f.txt", "# (design 3.3 Zeros)\n")
        self.assertEqual(sorted(breach.split(": ")[0] for breach in self.breaches("cites")),
                         ["gateway/a.cpp:2", "gateway/a.cpp:3", "gateway/b.cpp:1", "gateway/b.cpp:2", "gateway/c.cpp:1", "gateway/c.cpp:2",
                          "gateway/c.cpp:3", "gateway/c.cpp:4", "tests/bench/d.cpp:1", "tests/model/e.cpp:1", "tests/unit/f.txt:1"])

    def test_a_cite_of_what_is_there_is_let_pass(self):
        self.write("ARCHITECTURE.md", self.ARCHITECTURE)
        self.write("gateway/a.cpp", "// (design 3.3 and 3.4). (design 3.3 and 7) (design 3.4, discrete input 6); (design 3.3, FC 43/13); design 7, point 2.\n"
                                    "/// A stop (design 3.3 Edges, 3.4 Owed\n/// stops). Its frame: A3 00 00, or 01 A2.\n"
                                    'const char* frame = "A1 00";  // axis A\n')
        self.write("tests/bench/b.cpp", 'f("P2: fast");\n')
        self.write("tests/model/c.cpp", "// 3.3 Edges: \"is new\"; 3.4: \"A stop\".\n")
        self.write("docs/a.md", "as in design 3.4 Owed stops; CiA 301, 7.2\n")
        self.assertEqual(self.breaches("cites"), [])

    def test_a_fault_without_a_test_and_a_test_that_is_not_there_are_found(self):
        self.write("tests/unit/a_test.cpp", "TEST_P(Cable, IsPulled) {}\n")
        self.write("tests/integration/cable_test.py", "class Pulled(Story):\n    def test_idle(self):\n")
        good = "- `Cable.IsPulled`\n- `stories.cable.Pulled.test_idle`\n"
        page = "".join(f"## {n}. A fault\n{good}" for n in range(1, FAULTS + 1))
        self.write("docs/faults.md", page)
        self.assertEqual(self.breaches("fault_proofs"), [])
        self.write("docs/faults.md", page.replace("- `stories.cable.Pulled.test_idle`", "- `stories.cable.Pulled.test_moving`", 1))
        self.assert_breach("fault_proofs", "docs/faults.md:3")
        self.write("docs/faults.md", page.replace(good, "", 1))
        self.assert_breach("fault_proofs", "docs/faults.md:1")
        self.write("docs/faults.md", page.replace(f"## {FAULTS}. A fault\n{good}", ""))
        self.assert_breach("fault_proofs", "docs/faults.md:1")

    def test_a_rule_without_its_proof_an_id_used_twice_and_too_much_to_read_are_found(self):
        self.write("tests/unit/a_test.cpp", "TEST(Unheeded, StopIsNotDone) {}\n")
        self.write("tests/unit/modbus_tcp/dialogues/order.txt", "== a stop goes first\n")
        self.write("gateway/a.cpp", "// as STOP-2 says; HALF-STOP-9 is another\n")
        row = "| STOP-1 | A stop stops | it must | `Unheeded.StopIsNotDone` |\n"
        good = f"# Stops\n{row}| STOP-2 | All stops stop | as well | `order: a stop goes first`, `Unheeded.*` |\n"
        self.write("docs/rules/stops.md", good)
        self.assertEqual(self.breaches("rule_proofs"), [])
        for wrong, place in ((good.replace("`Unheeded.StopIsNotDone`", "`Unheeded.StopIsDone`"), "docs/rules/stops.md:2"),
                             (good.replace("`Unheeded.*`", "`Heeded.*`"), "docs/rules/stops.md:3"),
                             (good.replace("`Unheeded.StopIsNotDone`", "none"), "docs/rules/stops.md:2"),
                             (good.replace(" it must |", ""), "docs/rules/stops.md:2"),
                             (good + row, "docs/rules/stops.md:4"), (row, "gateway/a.cpp:1"),
                             (good + "x" * RULES_AND_DECISIONS, "docs/rules:1"), ("# Stops\n", "docs/rules:1")):
            self.write("docs/rules/stops.md", wrong)
            self.assert_breach("rule_proofs", place)

    def sizes(self, text):
        return {found.name: (found.functions, found.fields) for found in classes_of(text)}

    def test_functions_and_fields_of_a_class_are_counted(self):
        for members, has in (("int a, b = 2, *c; int d{1}, e[3]{};", (0, 5)), ("unsigned f : 3, g : 1, : 4; unsigned int : 0;", (0, 2)),
                             ("static constexpr int kA = 1; static inline int b_{2}; inline static const std::array<int, 2> c{1, 2};", (0, 0)),
                             ("using A = int; typedef int B; friend class C; friend bool operator==(A, B) { return true; } static_assert(f(1), \"(\");", (0, 0)),
                             ("X() = default; explicit X(int a, int b) : a_{a}, b_(b), c_<int>{1} { f(); } ~X();", (3, 0)),
                             ("int f() const { int local; if (a) { return 1; } return 2; } int a;", (1, 1)), ("void f(), g(int);", (2, 0)),
                             ("bool operator()(int) const; bool operator<(X) const; auto operator<=>(const X&) const = default; operator bool() const;", (4, 0)),
                             ("std::function<void(int)> f; std::map<int, std::vector<int>> g = h<int, int>(1, 2); void (*i)(int); int (&j)[2];", (0, 4)),
                             ("template <class T, int N = 3> requires(N > 2) T f(T t); template <typename T> struct In { T t; };", (1, 0)),
                             ("virtual auto f(int a = g(1)) -> std::vector<int> = 0; [[nodiscard]] decltype(f(1)) g() noexcept(true);", (2, 0)),
                             ("std::function<int()> f = [] { return 1; }; int a = g(1, 2), b = 3; decltype(f(1)) c; alignas(8) char d;", (0, 5)),
                             ("// int a;\n/* int b; */ char c = '\\''; const char* d = \"; int e;\"; int f = 1'000;\n#define G int g;\n", (0, 3)),
                             ("enum class E : int { one, two }; enum { three } a; struct F; struct F* b; class C f(); E e{E::one};", (1, 3)),
                             ("struct { int a; } b, c; union { int d; float e; }; struct { int x, y; void f(); } at;", (0, 5)),
                             ("public: int a; private: void f(); protected: class B;", (1, 1))):
            self.assertEqual(self.sizes(f"namespace n {{ class X final : public A<int>, B {{ {members} }}; }}").get("n::X"), has, members)

    def test_nested_classes_have_their_own_members(self):
        text = """int f(struct A* a) { return 1; }
namespace a::b { namespace { enum E { e }; }
template <class T> class X {
  struct Y : Z, W { int a; struct V { void f(); }; };
  Y y; Y g() { struct L { int a; }; return {}; }
};
inline X<int> x{1};
struct X<int>::Q { int q; }; }
extern "C" { struct C { int c; }; }"""
        self.assertEqual(self.sizes(text), {"a::b::X": (1, 1), "a::b::X::Y": (0, 1), "a::b::X::Y::V": (1, 0), "a::b::X::Q": (0, 1), "C": (0, 1)})

    def test_a_class_that_is_too_large_or_no_more_as_large_as_listed_is_found(self):
        def breaches(functions, fields, **larger):
            self.write("adapters/a.hpp", "struct X {\n" + "void f();\n" * functions + "int a;\n" * fields + "};\n")
            return [breach.removeprefix("adapters/a.hpp:1: X ") for breach in class_sizes(self.root, larger)]
        self.assertEqual(breaches(MOST_FUNCTIONS, MOST_FIELDS), [])
        self.assertEqual(breaches(FEWEST_FUNCTIONS - 1, MOST_FIELDS + 1), [], "a record")
        self.assertIn("declares 46 functions and has 18 fields", *breaches(MOST_FUNCTIONS + 1, MOST_FIELDS))
        self.assertIn("declares 45 functions and has 19 fields", *breaches(MOST_FUNCTIONS, MOST_FIELDS + 1))
        self.assertEqual(breaches(50, 20, X=(50, 20)), [])
        self.assertIn("has 51 functions, and may have no more than it had, 50", *breaches(51, 20, X=(50, 20)))
        self.assertIn("has 19 fields now: lower it to 19", *breaches(50, 19, X=(50, 20)))
        self.assertIn("take it out of LARGER", *breaches(40, 18, X=(50, 20)))
        self.assertIn("there is no class Y", *breaches(1, 1, Y=(50, 20)))

    def test_a_source_without_its_licence_is_found(self):
        self.write("gateway/core/good.cpp", "// SPDX-" "License-Identifier: Apache-2.0\nint x;\n")
        self.write("deploy/good", "#!/bin/sh\n# SPDX-" "License-Identifier: Apache-2.0\n")
        self.write("deploy/any.json", "{}\n")
        self.assertEqual(self.breaches("licence"), [])
        self.write("deploy/script", "#!/bin/sh\ntrue\n")
        self.write("gateway/core/CMakeLists.txt", "add_library(x)\n")
        self.write("gateway/core/empty.cpp", "")
        self.write("gateway/profile/eds/eds.cpp", "int x;\n")
        self.write(".githooks/hook", "#!/bin/sh\n")
        self.write(".github/workflows/ci.yml", "name: ci\n")
        self.write(".editorconfig", "root = true\n")
        self.write("deploy/plc/block.st", "// SPDX-" "License-Identifier: Apache-2.0\n")
        self.write("deploy/robot.urdf", '<?xml version="1.0"?>\n<!-- SPDX-' 'License-Identifier: Apache-2.0 -->\n')
        self.assertEqual([breach.split(": ")[0] for breach in self.breaches("licence")],
                         [".editorconfig:1", "gateway/core/CMakeLists.txt:1", "gateway/core/empty.cpp:1", "gateway/profile/eds/eds.cpp:1",
                          "deploy/plc/block.st:1", "deploy/script:2", ".githooks/hook:2", ".github/workflows/ci.yml:1"])


if __name__ == "__main__":
    unittest.main()
