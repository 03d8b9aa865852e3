# The wheel, installed as the README does it by hand, in an image without a compiler, pip or root.
FROM python:3.13-slim AS build
WORKDIR /src
COPY . .
RUN pip wheel --quiet --no-deps --wheel-dir /dist . \
 && python -m venv --without-pip /opt/looplab \
 && pip --python /opt/looplab/bin/python install --quiet --no-cache-dir -c requirements.lock /dist/*.whl \
 && find /opt/looplab/lib -type d -name tests -prune -exec rm -rf {} +

FROM python:3.13-slim
RUN useradd --system --uid 10001 --no-create-home looplab
COPY --from=build /opt/looplab /opt/looplab
ENV PATH=/opt/looplab/bin:$PATH PYTHONUNBUFFERED=1
USER looplab
EXPOSE 8000
HEALTHCHECK --interval=10s --timeout=5s --start-period=20s CMD ["python", "-c", \
  "import urllib.request as r; r.urlopen('http://127.0.0.1:8000/api/v1/health', timeout=4).read()"]
CMD ["looplab", "serve", "--host", "0.0.0.0", "--port", "8000"]
