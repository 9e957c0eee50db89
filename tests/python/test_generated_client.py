"""The OpenAPI document as generators of clients take it: it is valid, keeps the rules that they break on, and the
client that openapi-python-client makes of it takes a study from submission to histogram."""

import importlib
import json
import pkgutil
import subprocess
import sys
import time

import pytest
from openapi_spec_validator import validate

from conftest import SOURCE

DOCUMENT = json.loads((SOURCE / "schemas/openapi.json").read_text())


def schemas(value, place=""):
    """Every schema of the document with its place."""
    if isinstance(value, dict):
        if isinstance(value.get("type"), str) and "in" not in value and "scheme" not in value:
            yield place, value
        for name, member in value.items():
            yield from schemas(member, f"{place}/{name}")
    elif isinstance(value, list):
        for number, member in enumerate(value):
            yield from schemas(member, f"{place}/{number}")


def test_the_document_is_valid():
    validate(DOCUMENT)


def test_numbers_say_their_size():
    """Without a format Java and Go take 32 bits for a seed of 53, and single precision for a number."""
    wanted = {"integer": {"int32", "int64"}, "number": {"double"}}
    found = [
        place
        for place, schema in schemas(DOCUMENT)
        if schema.get("format") not in wanted.get(schema["type"], {schema.get("format")})
    ]
    assert not found, f"no format: {found}"
    narrow = [
        place
        for place, schema in schemas(DOCUMENT)
        if schema.get("format") == "int32" and schema.get("maximum", 0) >= 2**31
    ]
    assert not narrow, f"int32 cannot hold the maximum: {narrow}"
    assert len(list(schemas(DOCUMENT))) > 150


def test_objects_of_any_content_say_so():
    """Otherwise TypeScript makes Record<string, never> of them."""
    found = [
        place
        for place, schema in schemas(DOCUMENT)
        if schema["type"] == "object" and not {"properties", "additionalProperties"} & set(schema)
    ]
    assert not found, found


def test_names_differ_in_more_than_case():
    """Go makes one name of `problem` and `Problem`, whatever kind of component they are."""
    names = [name.lower() for kind in ("schemas", "responses", "parameters") for name in DOCUMENT["components"][kind]]
    names += [
        operation["operationId"].lower() + "response"
        for path in DOCUMENT["paths"].values()
        for operation in path.values()
    ]
    assert len(names) == len(set(names)), sorted(name for name in names if names.count(name) > 1)


@pytest.fixture(scope="module")
def generated(tmp_path_factory):
    directory = tmp_path_factory.mktemp("generated")
    (directory / "config.yml").write_text("post_hooks: []\n")
    done = subprocess.run(
        [
            sys.executable,
            "-m",
            "openapi_python_client",
            "generate",
            "--path",
            SOURCE / "schemas/openapi.json",
            "--output-path",
            directory / "generated_client",
            "--meta",
            "none",
            "--config",
            directory / "config.yml",
        ],
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0 and "Warning" not in done.stdout + done.stderr, done.stdout + done.stderr
    sys.path.insert(0, str(directory))
    yield importlib.import_module("generated_client")
    sys.path.remove(str(directory))


def test_every_module_is_imported_and_no_operation_is_missing(generated):
    names = [module.name for module in pkgutil.walk_packages(generated.__path__, "generated_client.")]
    for name in names:
        importlib.import_module(name)
    operations = sum(len(path) for path in DOCUMENT["paths"].values())
    made = [name for name in names if name.startswith("generated_client.api.") and name.count(".") == 3]
    assert len(made) == operations > 20


def test_from_submission_to_histogram(generated, daemon, case):
    from generated_client.api.jobs import dismiss, get_status
    from generated_client.api.processes import execute
    from generated_client.api.studies import get_exceedance, get_histogram, get_realization
    from generated_client.models import Execute, ExecuteInputs

    with generated.Client(base_url=daemon.url) as client:
        inputs = ExecuteInputs.from_dict({"case": case, "realizations": 2, "seed": 2**53 - 1})
        job = execute.sync("influence-zone", client=client, body=Execute(inputs=inputs))
        for _ in range(600):
            status = get_status.sync(job.job_id, client=client)
            if status.status.value == "successful":
                break
            time.sleep(0.05)
        assert status.seed == 2**53 - 1 and status.realizations.done == 2
        histogram = get_histogram.sync(job.job_id, client=client, bins=3)
        assert sum(histogram.histogram.counts) == 2 and len(histogram.bins) == 3
        assert get_exceedance.sync(job.job_id, client=client, x=0.0).k == 2
        assert get_realization.sync(job.job_id, 1, client=client).measures.front_mass_99_m > 0
        assert get_status.sync("0" * 32, client=client).status == 404  # a problem document
        assert dismiss.sync(job.job_id, client=client).status.value == "dismissed"
