"""The named errors and warnings of rendering."""


class SceneMapError(ValueError):
    """Raised for a map that cannot be used: unreadable, empty, or with values that are no geometry."""


class SceneMapWarning(UserWarning):
    """Warns of a map that can be used, but whose coordinates look like millimetres."""


class RendererClosedError(RuntimeError):
    """Raised when a renderer is used after it was closed."""


class OpenGLError(RuntimeError):
    """Raised if OpenGL cannot start or render, or belongs to the process that this one was forked from."""
