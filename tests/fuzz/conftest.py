"""The marker of what runs before a release alone."""


def pytest_configure(config):
    config.addinivalue_line("markers", "release: runs for minutes, before a release")
