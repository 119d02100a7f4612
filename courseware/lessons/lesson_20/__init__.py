"""Lesson 20, your own data: a reader's recording or pair of panoramas, else the course's; the ways to misread one."""
