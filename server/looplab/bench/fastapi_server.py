"""A bare POST in the framework the server is built on: FastAPI reads the body and sends so many bytes back.

`LOOPLAB_BENCH_BYTES` is the size of the answer. Run by the benchmark as ``uvicorn looplab.bench.fastapi_server:app``.
"""

from __future__ import annotations

import os

from fastapi import FastAPI, Request
from fastapi.responses import Response

ANSWER = b"x" * int(os.environ.get("LOOPLAB_BENCH_BYTES", "1000"))
app = FastAPI()


@app.post("/api/v1/loop")
async def echo(request: Request) -> Response:
    """Read all, answer as much as a gain move does."""
    await request.body()
    return Response(ANSWER, media_type="application/json")
