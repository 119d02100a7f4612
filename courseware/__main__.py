"""`python -m courseware COMMAND ...`: what course.py hands over to."""

import sys

from courseware.cli import main

sys.exit(main(sys.argv[1:]))
