"""What lesson 09 says about clouds, basins, bare corridors and stored results holds."""

import numpy as np
import pytest
from scipy.stats import chi2

from course_lib.beyond import AnnealedLocalizer
from course_lib.depth_mcl import DepthRenderer
from course_lib.experiments.six_degrees import ABLATIONS
from course_lib.geometry import optical_pose
from course_lib.lessons.kit.corridor_views import corridor_map
from course_lib.lessons.lesson_09.bare_corridor import STEP, Slide, slide
from course_lib.lessons.lesson_09.basin import BACK, DEGREES_PER_METRE, Basin, directions, levels, measure_basin
from course_lib.lessons.lesson_09.clouds import cloud_density
from course_lib.lessons.lesson_09.hand import hand_run, localize
from course_lib.lessons.lesson_09.panel import FRAME, STEPS, descend, refinement_panel, residuals
from course_lib.lessons.lesson_09.stored import ablation, each_recording, stored_rows, stored_table


def test_a_cloud_is_as_dense_as_its_distribution_says():
    rng = np.random.default_rng(3)
    drawn = (np.linalg.norm(rng.standard_normal((40_000, 3)), axis=1) <= 0.5).mean()
    assert cloud_density(200, 3, rng, 50).near == pytest.approx(200 * drawn, rel=0.1)
    # The median of the nearest of n: where one particle is farther with probability 2^(-1/n).
    nearest = cloud_density(200, 6, rng).nearest
    assert nearest == pytest.approx(np.sqrt(chi2.ppf(1 - 0.5 ** (1 / 200), 6)), rel=0.03)


def test_a_track_holds_the_errors_of_its_estimates():
    frames = [40, 44]
    with DepthRenderer(corridor_map(), hand_run().camera()) as renderer:
        track = localize(AnnealedLocalizer(renderer, 60, seed=10_001), frames, "test")
    true = hand_run().camera_to_world[frames]
    for k, estimate in enumerate(track.estimates):
        off = optical_pose(estimate.state)[:3, 3] - true[k][:3, 3]
        assert track.position[k] == pytest.approx(np.linalg.norm(off))
        assert track.deviations[k, :3] == pytest.approx(-off)
        assert np.rad2deg(np.linalg.norm(track.deviations[k, 3:])) == pytest.approx(track.rotation[k])
    assert track.statuses == ["tracked", "tracked"]
    assert track.position.max() < 0.05
    assert track.beyond_three_sigma == 0
    sigma = track.error_sigmas[1, 4]
    assert sigma**2 == pytest.approx(track.estimates[1].error_covariance[4, 4])
    far = track.deviations.copy()
    far[1, 4] = -3.1 * sigma
    assert track._replace(deviations=far).beyond_three_sigma == 1


@pytest.fixture(scope="module")
def basins() -> list[Basin]:
    return measure_basin(np.random.default_rng(10_002), starts=4)


def test_near_starts_come_back_and_far_ones_do_not(basins):
    shares = [one.back.mean() for one in basins]
    assert shares[0] > 0.85
    assert shares[-1] < 0.25
    assert all(one.back.shape == (8, 4) for one in basins)


def test_nothing_ends_between_the_truth_and_the_start(basins):
    far = basins[-2]
    between = (far.end_position > BACK[0]) & (far.end_position < far.offset / 3)
    assert between.mean() < 0.1


def test_starts_are_equally_far_in_both_ways():
    halves = directions(50, np.random.default_rng(1)).reshape(50, 2, 3)
    assert np.linalg.norm(halves, axis=-1) == pytest.approx(1.0)
    assert DEGREES_PER_METRE == 60


@pytest.fixture(scope="module")
def bare() -> Slide:
    return slide()


def test_in_a_bare_corridor_the_error_grows_by_every_step_and_sigma_is_wide_along_only(bare):
    assert np.diff(bare.along)[1:] == pytest.approx(-STEP, abs=0.03)
    assert (bare.sigma_along > 5 * bare.sigma_across).all()
    assert bare.across.max() < 0.005
    assert (np.abs(bare.along) < 3 * bare.sigma_along).all()
    assert set(bare.statuses[-4:]) == {"lost"}


def test_a_pillar_or_an_odometer_mends_it():
    assert np.abs(slide(pillar=True).along).max() < 0.01
    told = slide(odometer=True)
    assert np.abs(told.along).max() < 0.1
    assert (np.abs(told.along) < 3 * told.sigma_along).all()


def test_gauss_newton_comes_back_from_a_small_turn_and_not_from_a_large_one():
    near, far = descend(0.0, 0.0, 6.0, 0.1), descend(0.0, 0.0, 40.0, 0.1)
    assert near.rotation[0] == pytest.approx(6.0)
    assert near.position[-1] < 0.03
    assert near.rotation[-1] < 0.5
    assert far.rotation[-1] > 5
    assert len(near.position) == STEPS + 1


def test_a_start_forward_and_left_lies_there():
    true = hand_run().camera_to_world[FRAME]
    start = descend(0.3, 0.1, 0.0, 0.1).poses[0]
    right, down, forward = (true[:3, k] for k in range(3))
    assert start[:3, 3] - true[:3, 3] == pytest.approx(0.3 * forward - 0.1 * right, abs=1e-9)
    assert abs((start[:3, 3] - true[:3, 3]) @ down) < 1e-9


def test_plain_least_squares_leaves_the_truth_and_a_robust_scale_does_not():
    assert descend(0.0, 0.0, 0.0, 1e6).position[-1] > 0.15
    assert descend(0.0, 0.0, 0.0, 0.1).position[-1] < 0.03


def test_residuals_are_the_distances_of_measured_points_from_the_surfaces():
    found = descend(0.0, 0.0, 0.0, 0.1)
    r = residuals(found.images[-1])
    assert r.shape == levels()[1].measured.shape
    assert np.nanmedian(np.abs(r)) < 0.01
    assert np.nanmedian(np.abs(residuals(descend(0.0, 0.0, 15.0, 0.1).images[0]))) > 0.05


def test_the_buttons_of_the_panel_step():
    panel = refinement_panel()
    panel.press("Next step")
    panel.press("Next step")
    panel.press("Back")
    assert panel.values()["step"] == 1
    assert panel.draw(**panel.values()).summary.startswith("step 1: ")


def test_every_pooled_row_lies_between_its_recordings():
    recordings = each_recording()
    assert set(recordings) == {name for name in stored_rows("hand_1-5") if "floor" not in name}
    for name, rows in recordings.items():
        assert len(rows) == 5
        for key in ("mean_normalized_error", "within_3_sigma_percent"):
            assert np.mean([row[key] for row in rows]) == pytest.approx(stored_rows("hand_1-5")[name][key])


def test_the_ablation_has_everything_on_first_and_intervals_about_every_share():
    shares = ablation()
    assert next(iter(shares)) == "nothing"
    assert list(shares)[1:] == [name.removeprefix("without ") for name in ABLATIONS]
    assert all(low < share < high for share, (low, high) in shares.values())
    assert shares["refinement"][0] < 10 < shares["hypotheses"][0] < shares["nothing"][0]


def test_the_table_tells_every_row_but_the_second_images():
    lines = stored_table().splitlines()
    assert len(lines) == 2 + 7 + 6
    row = stored_rows("kitchen_six_degrees")["annealed and refined, every 8"]
    (line,) = [line for line in lines if line.startswith("kitchen: annealed and refined, every 8")]
    assert float(line.split()[-4]) == pytest.approx(row["median_position_m"], abs=5e-4)
