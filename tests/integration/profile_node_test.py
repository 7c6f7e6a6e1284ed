# SPDX-License-Identifier: Apache-2.0
"""`axisgate profile from-eds --node`: a drive on the bus answers beside its EDS, by reads alone. What is made of the answers is told by
ProfileFromEds of tests/profiles."""
import os

from stage import SOURCE, Story, main

EDS = f"{SOURCE}/tests/profiles/eds/complete.eds"


class ADriveBesideItsEds(Story):
    lines = {"can": "lawicel:ld2@3"}

    def setUp(self):
        super().setUp()
        self.simulate()

    def made(self, node):
        return self.command_line("profile", "from-eds", EDS, "--name", "made", "-o", self.path(""),
                                 "--node", f"slcan:{self.path('can')}:{node}")

    def test_what_it_says_goes_before_the_eds_and_nothing_is_written(self):
        ended = self.made(3)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        self.assertRegex(ended.stdout, r"answer +608Fh:01 is 0x[0-9a-f]+, read from node 3\n")
        self.assertRegex(ended.stdout, r"answer +60A9h is refused by node 3: taken for missing\n")
        self.assertRegex(ended.stdout, r"question +speed_units_per_rpm: ")
        self.assertEqual(self.sim.writes("can/3"), 0)

    def test_where_it_is_silent_nothing_is_made(self):
        ended = self.made(7)
        self.assertEqual(ended.returncode, 1)
        self.assertIn("node 7 on slcan:", ended.stderr)
        self.assertFalse(os.path.exists(self.path("made.json")))


if __name__ == "__main__":
    main()
