"""The ways in which an engine lies, and their consequences. Each file adds its own to the list."""
from hostile import frame_lies, introduction_lies, result_lies  # noqa: F401
from hostile.catalogue import WAYS

__all__ = ["WAYS"]
