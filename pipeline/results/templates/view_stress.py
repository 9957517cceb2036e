"""Picture of stress.vtkhdf at one cam angle: python view_stress.py [ANGLE [PICTURE.png]]

The angle in degrees, the nearest one of the file; without it that of the highest pressure. Without
a picture a window opens. Left both bodies, right the contact. Needs pyvista.
"""
# mypy: ignore-errors

import sys

if not getattr(sys.flags, "safe_path", False):
    del sys.path[0]  # the folder of this file, where nothing is a library

from pathlib import Path

import numpy as np
import pyvista
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline

SHARE = 0.02  # largest displacement shown, over half the height of the picture

reader = pyvista.get_reader(str(Path(__file__).with_name("stress.vtkhdf"))).reader
reader.UpdateInformation()
information = reader.GetOutputInformation(0)
steps = information.Length(Pipeline.TIME_STEPS())
angles = np.array([information.Get(Pipeline.TIME_STEPS(), k) for k in range(steps)])


def blocks_at(step):
    """The file at one step; its field data are those of the cam angle."""
    reader.SetStep(step)
    reader.Update()
    return pyvista.wrap(reader.GetOutputDataObject(0))


if len(sys.argv) > 1:
    chosen = int(np.abs(angles - float(sys.argv[1])).argmin())
else:
    chosen = int(np.argmax([blocks_at(k).field_data["p0_hertz_MPa"][0] for k in range(steps)]))
blocks = blocks_at(chosen)
notes = blocks.field_data
peak = float(np.nan_to_num(notes["von_mises_MPa"][0])) or 1.0
contact = np.array([notes["contact_x_mm"][0], notes["contact_y_mm"][0]])
middle, half = np.array(blocks.center[:2]), 0.55 * blocks.length / np.sqrt(2)
reach = 4.0 * float(notes["half_width_hertz_mm"][0]) or 1.0
picture = len(sys.argv) > 2
plotter = pyvista.Plotter(shape=(1, 2), off_screen=picture, window_size=(1600, 800))
for column, (centre, size) in enumerate(((middle, half), (contact, reach))):
    plotter.subplot(0, column)
    meshes = {name: blocks[name][0] for name in blocks.keys()}  # noqa: SIM118 - not a mapping
    near = [
        np.abs(mesh["displacement_mm"][np.hypot(*(mesh.points[:, :2] - centre).T) < size])
        for mesh in meshes.values()
    ]
    longest = max(each.max(initial=0.0) for each in near)
    factor = SHARE * size / longest if longest else 1.0
    for name, mesh in meshes.items():
        displaced = mesh.warp_by_vector("displacement_mm", factor=factor)
        displaced.points[:, 2] += 0.1 * reach * name.endswith("_contact")  # in front of the body
        plotter.add_mesh(displaced, scalars="von_mises_MPa", clim=(0.0, peak), lighting=False)
    text = f"{notes['load_case'][0]}, {angles[chosen]:g} deg, displacement x {factor:.3g}"
    plotter.add_text(text, font_size=10)
    plotter.view_xy()
    plotter.set_focus((*centre, 0.0))
    plotter.enable_parallel_projection()
    plotter.parallel_scale = size
sys.stdout.write(
    f"cam angle {angles[chosen]:g} deg, von Mises stress of the cam at most {peak:.4g} MPa\n"
)
plotter.show(screenshot=sys.argv[2] if picture else None)
