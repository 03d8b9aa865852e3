"""looplab: an interactive web control lab whose engine keeps dead time exact."""

__version__ = "0.1.0"
