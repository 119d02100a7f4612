"""Project P4, an unknown camera from raw frames to a report: its sessions, its stages, and what it is measured by."""
