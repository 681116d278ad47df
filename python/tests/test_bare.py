"""With numpy alone: tables are structured arrays."""

import numpy as np
import pytest

import orthopanel as op

FREQUENCIES = [321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5]


def has_pandas():
    try:
        import pandas  # noqa: F401
    except ImportError:
        return False
    return True


@pytest.mark.skipif(has_pandas(), reason="pandas is installed")
def test_tables_are_structured_arrays(piece):
    test = op.Test(piece)
    test.add_frequencies(FREQUENCIES)
    fit = op.identify(test)
    assert fit.constants.dtype.names == ("constant", "value", "std", "unit", "held")
    assert fit.constants["constant"].tolist() == ["e_x", "g_zx"]
    assert fit.covariance.shape == (2, 2)
    assert np.sqrt(fit.covariance[0, 0]) == pytest.approx(fit.constants["std"][0], rel=1e-14)
    assert fit.modes["measured_hz"].tolist() == FREQUENCIES
    assert np.isnan(fit.modes["zeta"]).all()
    with pytest.raises(ImportError, match="pip install matplotlib"):
        fit.plot()
    with pytest.raises(ImportError, match=r"pip install orthopanel\[campaign\]"):
        op.campaign.identify({"1": test}, "out")
