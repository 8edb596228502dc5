"""What the tests of the Python module share. Paths come in the environment, from tests/CMakeLists.txt."""

import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ["ZWIDTH_PROGRAM"]


@pytest.fixture(scope="session")
def random_devices(tmp_path_factory):
    """200 device files."""
    folder = tmp_path_factory.mktemp("devices")
    subprocess.run([os.environ["ZWIDTH_RANDOM_DEVICES"], str(folder), "200"], check=True)
    return sorted(folder.glob("*.toml"), key=lambda path: int(path.stem))


@pytest.fixture(scope="session")
def device_files():
    return sorted((ROOT / "devices").glob("*.toml"))


@pytest.fixture(scope="session", autouse=True)
def in_root():
    """Fixtures of a module or a session read files of the root too."""
    os.chdir(ROOT)


@pytest.fixture
def lhifam():
    import zwidth

    return zwidth.Device.from_toml(ROOT / "devices" / "lhifam.toml")
