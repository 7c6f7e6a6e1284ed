# SPDX-License-Identifier: Apache-2.0
"""All tests of containers, in one process. Run by tests/containers/run, in network, mount and process namespaces of their own:
containers_test.py AXISGATE AXISGATE_SIM SOURCE_FOLDER [unittest's arguments]
"""
import sys
import unittest

import container_stage  # noqa: F401  first: it finds the modules of the stories
from cell_test import CellTest  # noqa: F401
from images_test import Images  # noqa: F401
from one_gateway_test import ManyGateways, OneGateway  # noqa: F401

if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
