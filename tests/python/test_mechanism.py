"""zwidth.Mechanism and zwidth.workspace()."""

import json
import subprocess

import numpy as np
import pytest

import zwidth
from conftest import PROGRAM, ROOT

ARM = ROOT / "devices" / "mechanisms" / "planar_arm.toml"
XML = ROOT / "devices" / "mechanisms" / "planar_arm.xml"
KNOWN = json.loads((ROOT / "tests" / "reference" / "planar_arm.json").read_text())


@pytest.fixture(scope="module")
def arm():
    return zwidth.Device.from_toml(ARM)


@pytest.fixture(scope="module")
def mechanism():
    return zwidth.Mechanism(XML, tip="tip")


def test_joints_and_poses(mechanism):
    names = [joint.name for joint in mechanism.joints]
    assert names == ["shoulder", "elbow", "motor 1", "motor 2"]
    assert {joint.motion for joint in mechanism.joints} == {"rotary"}
    assert len(mechanism.pose_joints) == 2 and set(mechanism.pose_joints) <= set(names)


@pytest.mark.parametrize("shoulder, elbow", [(0.3, 1.2), (-1.0, 0.4)])
def test_tip_and_jacobian_of_a_planar_arm(mechanism, shoulder, elbow):
    at = mechanism.at({"shoulder": shoulder, "elbow": elbow})
    both = shoulder + elbow
    upper, fore = 0.2 * np.array([np.cos(shoulder), np.sin(shoulder), 0]), 0.25 * np.array([np.cos(both), np.sin(both), 0])
    np.testing.assert_allclose(at.tip_position, upper + fore, atol=1e-12)
    turned = np.cross([0, 0, 1], np.array([upper + fore, fore])).T
    order = [joint.name for joint in mechanism.joints].index
    np.testing.assert_allclose(at.joints[[order("shoulder"), order("elbow")]], [shoulder, elbow], atol=1e-12)
    np.testing.assert_allclose(at.jacobian[:, [order("shoulder"), order("elbow")]], turned, atol=1e-12)
    # M of two links, to the last digits: the elbow's own is its inertia and mass about the joint.
    np.testing.assert_allclose(at.mass, at.mass.T, rtol=1e-12)
    assert at.mass[order("elbow"), order("elbow")] == pytest.approx(6e-4 + 0.10 * 0.12**2, rel=1e-9)
    assert sorted(at.element_stiffness[at.element_stiffness > 0]) == pytest.approx([300, 400])
    assert at.element_weights.shape == (len(at.element_damping), at.mass.shape[0])
    assert not at.mass.flags.writeable and not at.mass.flags.owndata


def test_what_an_array_sees_outlives_the_pose(mechanism):
    mass = mechanism.at({"elbow": 0.7}).mass
    copy = mass.copy()
    for _ in range(100):
        mechanism.at({"elbow": 1.0})
    np.testing.assert_array_equal(mass, copy)


def test_a_pose_in_the_order_of_its_joints(mechanism):
    numbers = np.array([0.3, 1.2])
    named = dict(zip(mechanism.pose_joints, numbers))
    np.testing.assert_array_equal(mechanism.at(numbers).mass, mechanism.at(named).mass)


def test_of_a_text_and_of_a_device(arm, mechanism):
    pose = {"shoulder": 0.3, "elbow": 1.2}
    of_text = zwidth.Mechanism(XML.read_text(), "tip")
    np.testing.assert_array_equal(of_text.at(pose).mass, mechanism.at(pose).mass)
    np.testing.assert_array_equal(zwidth.Mechanism.of(arm).at(pose).jacobian, mechanism.at(pose).jacobian)


def test_a_motor_behind_a_joint_of_a_file_without(mechanism):
    text = XML.read_text()
    without = text[: text.index("<tendon>")] + "</mujoco>"
    motors = [{"joint": joint, "ratio": 10, "inertia": 8e-5, "stiffness": 400} for joint in ("shoulder", "elbow")]
    at = zwidth.Mechanism(without, "tip", transmissions=motors).at({"elbow": 1.0})
    assert at.motors.shape[0] == 2
    assert sorted(at.element_stiffness[at.element_stiffness > 0]) == pytest.approx([400, 400])


def test_reach(mechanism):
    point = mechanism.at({"shoulder": 0.5, "elbow": 1.0}).tip_position
    found = mechanism.reach(point)
    assert found.reached
    np.testing.assert_allclose(mechanism.at(found.pose).tip_position, point, atol=1e-9)
    assert not mechanism.reach([2, 0, 0]).reached


@pytest.mark.parametrize(
    "asked, where",
    [
        (lambda: zwidth.Mechanism("no such.xml", "tip"), None),
        (lambda: zwidth.Mechanism(XML, "no such site"), None),
        (lambda: zwidth.Mechanism(XML, "tip", encoders="motor 1"), "encoders"),
        (lambda: zwidth.Mechanism(XML, "tip", transmissions=[{"ratio": 2}]), "transmissions[0]"),
        (lambda: zwidth.Mechanism(XML, "tip", transmissions=[{"joint": "elbow", "gear": 2}]), "transmissions[0].gear"),
        (lambda: zwidth.Mechanism(b"<mujoco>", "tip"), "mechanism"),
        (lambda: zwidth.Mechanism("<mujoco>\n<broken", "tip"), None),
        (lambda: zwidth.Mechanism(XML, "tip").at({"no such": 1.0}), None),
        (lambda: zwidth.Mechanism(XML, "tip").at({"elbow": float("nan")}), None),
        (lambda: zwidth.Mechanism(XML, "tip").at({"elbow": "1 rad"}), "pose.elbow"),
        (lambda: zwidth.Mechanism(XML, "tip").at([1.0]), "pose"),
        (lambda: zwidth.Mechanism(XML, "tip").reach([1.0, 2.0]), "point"),
        (lambda: zwidth.Mechanism.of(zwidth.Device.from_toml(ROOT / "devices" / "lhifam.toml")), "device"),
    ],
)
def test_refused(asked, where):
    with pytest.raises(zwidth.InputError) as refused:
        asked()
    assert where is None or refused.value.where == where
    assert refused.value.what


def test_no_value_behind_new():
    with pytest.raises(TypeError):
        zwidth.Mechanism.at(zwidth.Mechanism.__new__(zwidth.Mechanism), {})


def test_known_limits(arm):
    """Those of the reference: limits as arrays, poses x directions."""
    known = [each for each in KNOWN if each.get("normal") and each["delay"] == 0]
    poses = np.unique([each["pose"] for each in known], axis=0)
    for pose in poses:
        here = [each for each in known if each["pose"] == pose.tolist()]
        normals = np.array([each["normal"] for each in here])
        answer = zwidth.workspace(arm, poses={"shoulder": pose[:1], "elbow": pose[1:]}, normals=normals)
        assert answer.limits.shape == (1, len(here))
        np.testing.assert_allclose(answer.limits[0], [each["critical_stiffness"] for each in here], rtol=1e-6)
        given = np.array(["any_user" in each for each in here])
        any_user = [each["any_user"]["critical_stiffness"] for each in here if "any_user" in each]
        np.testing.assert_allclose(answer.any_user_limits[0, given], any_user, rtol=2e-4)
        np.testing.assert_allclose(answer.normals[0], normals / np.linalg.norm(normals, axis=1, keepdims=True), atol=1e-12)


def test_the_document_is_the_commands(arm):
    answer = zwidth.workspace(arm, poses="shoulder=0:60:3 deg,elbow=40:120:3 deg", directions=8, stiffness="300 N/m")
    grid = ["--poses", "shoulder=0:60:3 deg,elbow=40:120:3 deg", "--normals", "8", "--stiffness", "300 N/m"]
    printed = subprocess.run([PROGRAM, "workspace", ARM, *grid, "--json"], capture_output=True, text=True, check=True)
    assert answer.to_dict() == json.loads(printed.stdout)
    assert answer.limits.shape == answer.any_user_limits.shape == (9, 8) and answer.normals.shape == (9, 8, 3)
    assert np.all(answer.any_user_limits <= answer.limits * (1 + 1e-4))


def test_arrays_and_a_grid_say_the_same(arm, mechanism):
    shoulder, elbow = np.meshgrid(np.linspace(0, 1, 3), np.linspace(0.7, 2, 2), indexing="ij")
    values = {"shoulder": shoulder.ravel(), "elbow": elbow.ravel()}
    by_array = zwidth.workspace(arm, poses=np.column_stack([values[each] for each in mechanism.pose_joints]), directions=6)
    by_joint = zwidth.workspace(arm, poses=values, directions=6)
    by_text = zwidth.workspace(arm, poses="shoulder=0:1:3,elbow=0.7:2:2", directions=6)
    np.testing.assert_array_equal(by_array.limits, by_joint.limits)
    np.testing.assert_allclose(by_array.limits, by_text.limits, rtol=1e-9)
    np.testing.assert_allclose(by_array.any_user_limits, by_text.any_user_limits, rtol=1e-9)


def test_points_and_the_worst_device(arm):
    answer = zwidth.workspace(arm, points=[[0.3, 0.1, 0.0], [0.2, 0.2, 0.0]], normals=[1, 0, 0])
    assert answer.limits.shape == (2, 1)
    worst = answer.worst_device()
    limit = zwidth.analyze(worst).limits.any_user.critical_stiffness
    assert limit == pytest.approx(np.nanmin(answer.any_user_limits), rel=2e-4)


def test_a_direction_that_has_no_limit_is_nan(arm):
    with pytest.warns(zwidth.ResultWarning):
        answer = zwidth.workspace(arm, poses={"elbow": [1.2]}, normals=[[1, 0, 0], [0, 0, 1], [0, 1, 0]])
    assert np.isnan(answer.limits[0, 1]) and np.isfinite(answer.limits[0, [0, 2]]).all()


@pytest.mark.parametrize(
    "options, where",
    [
        ({"poses": [[1.0]]}, "poses"),
        ({"poses": {"shoulder": [0.0, 1.0], "elbow": [1.0]}}, "poses"),
        ({"poses": {"no such": [1.0]}}, None),
        ({"poses": [[1.0, np.nan]]}, "poses"),
        ({"poses": np.zeros((0, 2))}, "poses"),
        ({"normals": [[1.0, 0.0]]}, "normals"),
        ({"normals": [[0.0, 0.0, 0.0]]}, None),
        ({"directions": 0}, "directions"),
        ({"directions": 3, "normals": [1, 0, 0]}, "options.directions"),
        ({"points": "somewhere"}, None),
        ({"stiffness": -1}, None),
        ({"pose": 3}, "options.pose"),
    ],
)
def test_refused_workspace(arm, options, where):
    with pytest.raises(zwidth.InputError) as refused:
        zwidth.workspace(arm, **options)
    assert where is None or refused.value.where == where


def test_no_mechanism():
    with pytest.raises(zwidth.InputError):
        zwidth.workspace(zwidth.Device.from_toml(ROOT / "devices" / "lhifam.toml"))


def test_progress_ends_the_work(arm):
    told = []

    def stop(done):
        told.append(done)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        zwidth.workspace(arm, poses="shoulder=0:90:60 deg,elbow=20:150:60 deg", progress=stop)
    assert told and 0 <= told[0] <= 1
