"""`python -m looplab` is `looplab`, for where the script is not on the path."""

from looplab.cli import app

# worker processes read this file again
if __name__ == "__main__":
    app(prog_name="looplab")
