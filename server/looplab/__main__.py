"""`python -m looplab` is `looplab`, for where the script is not on the path."""

from looplab.cli import app

app(prog_name="looplab")
