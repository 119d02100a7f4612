"""The commands of course.py, one module each; course_lib.cli holds the table."""
