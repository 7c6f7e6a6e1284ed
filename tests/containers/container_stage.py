# SPDX-License-Identifier: Apache-2.0
"""What the tests of containers share: podman, the folder of the sources, and configurations that a busy machine does not disturb."""
import json
import os
import re
import shlex
import sys

SIMULATOR, SOURCE = (os.path.abspath(path) for path in sys.argv[2:4])
sys.path[:0] = [f"{SOURCE}/tests/integration", f"{SOURCE}/tests/docs"]

from engine import Engine  # noqa: E402

ENGINE = Engine(shlex.split(os.environ["AXISGATE_ENGINE"]))
USER = 10001


def plain_json(path):
    """A configuration without its comments."""
    with open(path, encoding="utf-8") as file:
        return json.loads(re.sub(r"//.*", "", file.read()))


def patient(config):
    """For a machine that is busy with something else: whoever is silent for a second is not gone."""
    for listener in config["modbus_tcp"]:
        listener.update(start_deadline_ms=60000, reply_deadline_ms=60000)
    for bus in config["buses"]:
        bus["timeout_ms"] = 1000
        for drive in bus["drives"]:
            for axis in drive["axes"]:
                if axis.get("lease"):
                    axis["lease"]["timeout_ms"] = 10000
    return config
