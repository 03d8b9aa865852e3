"""looplab: an interactive web control lab.

The control theory lives in `looplab.engine` and needs numpy and scipy only; `looplab.api` serves it.
"""

__version__ = "0.1.0"
