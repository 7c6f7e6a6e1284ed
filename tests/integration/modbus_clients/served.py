# SPDX-License-Identifier: Apache-2.0
"""Starts and ends the server that the clients under test speak to."""
import subprocess


class Served:
    def __init__(self, program, *options):
        self.process = subprocess.Popen([program, *options], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        word, _, port = self.process.stdout.readline().partition(" ")
        assert word == "PORT", "the server did not start"
        self.port = int(port)

    def stop(self):
        self.process.stdin.close()
        self.process.stdout.close()
        assert self.process.wait(timeout=20) == 0
