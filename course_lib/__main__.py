"""`python -m course_lib COMMAND ...`: what course.py hands over to."""

import sys

from course_lib.cli import main

sys.exit(main(sys.argv[1:]))
