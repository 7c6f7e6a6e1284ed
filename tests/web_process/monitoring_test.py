# SPDX-License-Identifier: Apache-2.0
"""What deploy/monitoring brings: Prometheus and Alertmanager take it, each alert is raised when it should be and names its word, the
dashboard says its units and shows no data as none. That its metrics are there, web_process_tests see.

monitoring_test.py SOURCE_FOLDER AXISGATE [unittest's arguments]
"""
import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE, AXISGATE = (Path(each).absolute() for each in sys.argv[1:3])
FOLDER = SOURCE / "deploy/monitoring"
TOOLS = SOURCE / ".deps/prometheus/usr/bin"  # tests/setup puts them there
STORIES = SOURCE / "tests/web_process/rules_test.yml"
ALERT = re.compile(r"^ +- alert: (\w+)$", re.MULTILINE)


def said_by(*command):
    done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    return done.returncode, done.stdout + done.stderr


class Rules(unittest.TestCase):
    def setUp(self):
        self.rules = (FOLDER / "rules.yml").read_text(encoding="utf-8")

    def test_prometheus_and_alertmanager_take_what_is_here(self):
        for command in (("promtool", "check", "config", "--syntax-only", FOLDER / "prometheus.yml"), ("promtool", "check", "rules", FOLDER / "rules.yml"),
                        ("amtool", "check-config", FOLDER / "alertmanager.yml")):
            code, said = said_by(TOOLS / command[0], *command[1:])
            self.assertEqual(code, 0, said)

    def test_each_alert_is_raised_when_it_should_be(self):
        code, said = said_by(TOOLS / "promtool", "test", "rules", STORIES)
        self.assertEqual(code, 0, said)
        told = re.findall(r"^ +alertname: (\w+)\n +exp_alerts:\n", STORIES.read_text(encoding="utf-8"), re.MULTILINE)
        self.assertEqual(set(told), set(ALERT.findall(self.rules)), "each has a story in which it is raised")

    def test_each_alert_names_its_word_and_its_page(self):
        pages = re.search(r"const PAGES = \[(.*?)\]", (SOURCE / "gateway/upstream/web_process/pages/main.js").read_text(encoding="utf-8"))[1]
        for part in re.split(r"^ +- alert: ", self.rules, flags=re.MULTILINE)[1:]:
            name = part.split("\n", 1)[0]
            with self.subTest(alert=name):
                word = re.search(r'explain: "axisgate explain (.*)"', part)[1]
                words = [word]
                if "{{" in word:  # the words that its expression lets through
                    label = re.search(r"\.(\w+) ", word)[1]
                    words = re.search(label + r'=~"(.*?)"', part)[1].split("|")
                for each in words:
                    code, said = said_by(AXISGATE, "explain", *each.split())
                    self.assertEqual(code, 0, said)
                page = re.search(r'page: "http://{{ \$labels\.instance }}/#/(\w+)', part)[1]
                self.assertIn(f'"{page}"', pages)


class Dashboard(unittest.TestCase):
    def setUp(self):
        self.board = json.loads((FOLDER / "dashboard.json").read_text(encoding="utf-8"))

    def test_it_has_a_cell_its_buses_and_its_axes(self):
        self.assertEqual([each["title"] for each in self.board["panels"] if each["type"] == "row"], ["Cell", "Bus", "Axis"])
        ids = [each["id"] for each in self.board["panels"]]
        self.assertEqual(len(ids), len(set(ids)))

    def test_each_panel_says_its_unit_and_shows_no_data_as_none(self):
        for each in self.board["panels"]:
            if each["type"] == "row":
                continue
            with self.subTest(panel=each["title"]):
                defaults = each["fieldConfig"]["defaults"]
                self.assertTrue(defaults["unit"])
                self.assertEqual(defaults["noValue"], "no data")
                if "custom" in defaults:
                    self.assertIs(defaults["custom"]["spanNulls"], False, "a gap is no line")

    def test_each_query_is_one_and_asks_the_gateways_that_are_chosen(self):
        rules = ["groups:", "- name: board", "  rules:"]
        for panel in self.board["panels"]:
            for target in panel.get("targets", ()):
                self.assertIn('instance=~"$gateway"', target["expr"], panel["title"])
                query = target["expr"].replace("$__rate_interval", "1m")
                rules += [f"  - record: query_{len(rules)}", "    expr: " + json.dumps(query)]
        with tempfile.NamedTemporaryFile("w", suffix=".yml") as file:
            file.write("\n".join(rules))
            file.flush()
            code, said = said_by(TOOLS / "promtool", "check", "rules", file.name)
        self.assertEqual(code, 0, said)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
