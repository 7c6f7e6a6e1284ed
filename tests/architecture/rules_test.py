#!/usr/bin/env python3
"""Each rule finds what it forbids, and lets the allowed pass: a rule that never fires guards nothing."""
import tempfile
import unittest
from pathlib import Path

import rules

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
        self.write("gateway/image/a.cpp", '#include "gateway/image/a.hpp"\n#include "gateway/drive/model.hpp"\n')
        self.assert_breach("arrows", "gateway/image/a.cpp:2")

    def test_an_arrow_in_the_direction_is_let_pass(self):
        self.write("gateway/upstream/modbus_tcp/a.cpp", '#include "gateway/image/a.hpp"\n#include <vector>\n')
        self.write("gateway/app/b.cpp", '#include "adapters/serial/port.hpp"\n')
        self.write("adapters/kinco/c.cpp", '#include "adapters/bus/wire.hpp"\n')
        self.assertEqual(self.breaches("arrows"), [])

    def test_one_adapter_must_not_know_another(self):
        self.write("adapters/kinco/a.cpp", '#include "adapters/serial/port.hpp"\n')
        self.assert_breach("arrows", "adapters/kinco/a.cpp:1")

    def test_a_simulated_drive_must_not_know_the_gateway(self):
        self.write("tests/simulated/a.cpp", '#include "adapters/kinco/codec.hpp"\n')
        self.assert_breach("arrows", "tests/simulated/a.cpp:1")

    def test_a_folder_without_a_rule_is_found(self):
        self.write("gateway/new/a.cpp", '#include "gateway/core/error.hpp"\n')
        self.assert_breach("arrows", "gateway/new/a.cpp:1")

    def test_a_header_that_only_one_place_may_know_is_found(self):
        self.write("gateway/drive/a.cpp", "#include <linux/can/raw.h>\n")
        self.assert_breach("one_place", "gateway/drive/a.cpp:1")

    def test_io_in_a_deciding_file_is_found_and_a_shell_is_let_pass(self):
        self.write("adapters/bus/arbiter.cpp", "int x;\n#include <boost/asio/post.hpp>\n")
        self.write("gateway/upstream/modbus_tcp/server.cpp", "#include <boost/asio/post.hpp>\n")
        self.assert_breach("deciding", "adapters/bus/arbiter.cpp:2")

    def test_a_clock_in_a_deciding_file_is_found(self):
        self.write("gateway/drive/motion.cpp", "auto now = std::chrono::steady_clock::now();\n")
        self.assert_breach("deciding", "gateway/drive/motion.cpp:1")

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


if __name__ == "__main__":
    unittest.main()
