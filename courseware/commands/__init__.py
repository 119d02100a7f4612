"""The commands of course.py, one module each; courseware.cli holds the table."""
