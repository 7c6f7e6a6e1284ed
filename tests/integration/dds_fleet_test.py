# SPDX-License-Identifier: Apache-2.0
"""Ten gateways of fifty axes each behind one discovery server: one reader sees all 500 axes, and `topics --all` shows them in one
table."""
from own_network import make_interfaces  # first: it begins anew in a network of its own

import json
import subprocess

from dds_stage import DdsStory, main
from processes import Program, until
from stage import AXISGATE, Gateway

GATEWAYS, AXES = 10, 50
SERVER = "127.0.0.1:11811"
PATIENCE = 300  # seconds: ten gateways and a reader of all of them on a machine that has other things to do


def setUpModule():
    make_interfaces()


class Fleet(DdsStory):
    """Their lines are not plugged in: an axis is one all the same."""

    def setUp(self):
        super().setUp()
        self.keep(Program("discovery server", ["fast-discovery-server", "-i", "0", "-l", "127.0.0.1", "-p", "11811"]))

    def configure_gateway(self, name, axes=AXES):
        drives = [{"profile": "kinco-jd", "node": 1 + index, "axes": [{"axis": 1 + index, "name": f"axis_{1 + index}"}]} for index in range(axes)]
        config = {"gateway": {"name": name}, "modbus_tcp": [self.listener()],
                  "dds": {"domain": self.domain, "discovery_servers": [SERVER]},
                  "buses": [{"name": "line", "adapter": "kinco-serial", "device": self.path("not-plugged-in"), "poll": {"fast": 20000, "normal": 60000, "slow": 60000},
                             "drives": drives}]}
        path = self.path(f"{name}.json")
        with open(path, "w", encoding="utf-8") as out:
            json.dump(config, out)
        return path

    def start_gateway(self, path):
        gateway = self.keep(Gateway(path))
        gateway.name = path
        return gateway.wait_until_it_listens()

    def shown_once(self, path, *more):
        """The table of `topics`. Nothing where a busy machine did not let it come to its end: the story asks again."""
        try:
            return self.command_line("topics", path, "--once", *more).stdout
        except subprocess.TimeoutExpired:
            return ""

    def test_one_reader_sees_all_axes_of_ten_gateways(self):
        paths = [self.configure_gateway(f"cell_{number}") for number in range(GATEWAYS)]
        for path in paths:
            self.start_gateway(path)
        topics = self.keep(Program("topics", [AXISGATE, "topics", paths[0], "--all", "--json"]))

        def seen():
            samples = [json.loads(line) for line in list(topics.lines) if line.startswith("{")]
            return {(sample["gateway"], sample["axis"]) for sample in samples}

        wanted = {(f"cell_{gateway}", axis) for gateway in range(GATEWAYS) for axis in range(1, AXES + 1)}
        until("all axes are seen", lambda: seen() == wanted, PATIENCE)
        table = until("its own are shown", lambda: self.shown_once(paths[3]), PATIENCE)
        self.assertIn("cell_3", table)
        self.assertNotIn("cell_4", table, "without --all it is the configuration's own")
        topics.terminate()
        until("the table has them all", lambda: self.rows_of_the_table(paths[0]) == (
            {(f"cell_{gateway}", AXES) for gateway in range(GATEWAYS)}, wanted), PATIENCE)

    def rows_of_the_table(self, path):
        """What `topics --all` shows without --json: gateways and how many axes each has, and the axes that have a name and a link."""
        gateways, _, axes = self.shown_once(path, "--all").partition("\n\n")
        return ({(row[0], int(row[2])) for line in gateways.splitlines()[1:] if (row := line.split())[1] != "gone"},
                {(row[0], int(row[1])) for line in axes.splitlines()[1:] if (row := line.split())[2] == f"axis_{row[1]}" and row[3:]})


if __name__ == "__main__":
    main()
