"""First case of the template with a flat or curved face on an arm in place of stem and roller."""

from camwright.pipeline.case.template import first_case

FLAT, CURVED = 'offset = "5 mm"\nwidth = "44 mm"', 'radius = "23.5 mm"\nwidth = "24 mm"'
SHAPES = {"flat": FLAT, "curved": CURVED}
_BASE = {"flat": "40 mm", "curved": "60 mm"}
_FOLLOWER = """\
[follower]
kind = "oscillating"
mass = "1.1 kg"

[follower.arm]
centre_distance = "110 mm"
length = "95 mm"
swing = "{swing}"

[follower.face]
{shape}
depth = "15 mm"
end = {{ kind = "sharp" }}
thickness = "10 mm"
friction = 0.05
roughness = "0.2 um"
pv_limit = "6000 MPa m/s"
material = "case_hardened"

[scope]
not_covered = ["arm"]
reason = "its pivot is judged by its maker"

"""


def face_text(kind: str = "flat", problem: str = "lift", swing: str = "with") -> str:
    """Text of the case; problem: that of the template, whose lift or torque it has."""
    whole = first_case("swing", problem).text
    before, after = whole[: whole.index("[roller]")], whole[whole.index("[lubricant]") :]
    text = before + _FOLLOWER.format(shape=SHAPES[kind], swing=swing) + after
    text = text.replace('prime_radius = "60 mm"', f'prime_radius = "{_BASE[kind]}"')
    return text.replace('width = "15.5 mm"', 'width = "15 mm"').replace('"2 W/K"', '"12 W/K"')
