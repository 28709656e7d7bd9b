# SPDX-License-Identifier: BSD-3-Clause
import sys

from nanotouch_app.main import main

sys.exit(main())
