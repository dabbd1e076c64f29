# robolink in a container, for servers and classes: docker build -t robolink . && docker run --rm -it robolink
# Nobody has built this image yet; the wheel in it is what the tests install.
FROM python:3.13-slim AS build
WORKDIR /source
COPY . .
# hadolint ignore=DL3013
RUN pip install --no-cache-dir build && python -m build --wheel --outdir /dist .

# Newest versions, as the wheel allows them: the tests run with these, too.
FROM python:3.13-slim
COPY --from=build /dist /dist
# hadolint ignore=DL3013
RUN pip install --no-cache-dir "$(ls /dist/*.whl)[bag,plot,test]" opencv-python-headless && rm -r /dist \
    && useradd --create-home --uid 1000 student
USER 1000
WORKDIR /home/student
# With the page: docker run --rm -p 127.0.0.1:8765:8765 robolink sh -c 'robolink launch wander & robolink view --host 0.0.0.0'
EXPOSE 8765
CMD ["robolink", "launch", "wander"]
