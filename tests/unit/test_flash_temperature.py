"""Flash temperature of a band contact against worked examples."""

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.contact.flash_temperature import effusivity, flash_temperature

STEEL = effusivity(46.0, 7800.0, 460.0)


def test_the_band_source_of_a_worked_example():
    """Friction 0.1 under 50 N/mm at 2 and 1 m/s, half-width 81.37 um: 14.03 K."""
    heat = 0.1 * 50e3 * (2.0 - 1.0)
    rise = flash_temperature(heat, (2.0, 1.0), (STEEL, STEEL), 81.37e-6)
    assert rise == pytest.approx(14.03, rel=1e-3)


def test_the_heat_goes_where_the_surface_is_fast_and_conducts():
    fast, slow = (flash_temperature(1e4, (u, 0.0), (STEEL, STEEL), 1e-4) for u in (4.0, 1.0))
    assert slow / fast == pytest.approx(2.0, rel=1e-12)
    other = flash_temperature(1e4, (1.0, 1.0), (STEEL, 3.0 * STEEL), 1e-4)
    assert slow / other == pytest.approx(4.0, rel=1e-12)


def test_without_heat_there_is_no_rise_and_a_nan_stays():
    assert flash_temperature(0.0, (0.0, 0.0), (STEEL, STEEL), 1e-4) == 0.0
    assert np.isnan(flash_temperature(1e4, (1.0, 1.0), (np.nan, STEEL), 1e-4))


@pytest.mark.parametrize("half_width", [0.0, -1e-4, np.nan])
def test_a_half_width_out_of_range_is_refused(half_width):
    with pytest.raises(InputError, match="half_width"):
        flash_temperature(1e4, (1.0, 1.0), (STEEL, STEEL), half_width)
