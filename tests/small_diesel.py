"""What a small naturally aspirated diesel has in place of the defaults of `CylinderEngine`."""

from math import radians

SMALL_DIESEL = {
    "ignition": "compression",
    "compression_ratio": 20.0,
    "intake_pressure": 98.0e3,
    "spark": radians(342.0),
    "ignition_delay": radians(8.0),
    "burn_duration": radians(60.0),
    "wiebe_a": 5.0,
    "wiebe_m": 0.9,
    "premixed_share": 0.35,
    "combustion_efficiency": 0.98,
    "air_fuel_ratio": 40.0,
    "lower_heating_value": 42.8e6,
}
