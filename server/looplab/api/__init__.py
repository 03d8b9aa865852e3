"""The REST API and the pages: FastAPI, thin routes over the engine."""
