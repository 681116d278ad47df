"""Both campaigns with a few panels and draws, on one cluster."""

import numpy as np
import pytest
import rail_car_comfort
import traced_panels
from distributed import Client

import orthopanel as op


@pytest.fixture(scope="module", autouse=True)
def cluster():
    # The current client: campaigns take it.
    with Client(n_workers=2, threads_per_worker=1, dashboard_address=None) as client:
        yield client


def test_traced_panels(tmp_path):
    found = traced_panels.main([str(tmp_path), "--panels", "10", "--kind", "local-mass"])
    rates = {rate["name"]: rate for rate in found["rates"]}
    assert rates["right effect named or among the alternatives"]["reached"] == 1.0


def test_comfort_has_an_interval(tmp_path):
    floor = rail_car_comfort.identified()
    runs = op.campaign.runs(floor.sample(4, seed=1), rail_car_comfort.ride, tmp_path).compute()
    assert runs["failed"].isna().all() and runs["comfort"].nunique() == 4
    # The README of the rail car: 0.1542 m/s2 without the bracket, coupled by an SSP.
    assert rail_car_comfort.ride(rail_car_comfort.truth())["comfort"] == pytest.approx(0.15415, abs=1e-5)
    assert np.abs(runs["comfort"] / 0.15415 - 1.0).max() < 0.05
