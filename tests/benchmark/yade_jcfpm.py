"""The packing and the bonds of a run, stepped by Yade's jointed cohesive model (JCFPM).

    yade -n -x -j1 tests/benchmark/yade_jcfpm.py RUN_DIRECTORY [STEPS]

Needs the Debian package yade. RUN_DIRECTORY is that of a specimen of grains alone. Every
joint of the run becomes a cohesive interaction, with the same stiffness and no chance to
break; grains move in the plane. Prints steps a CPU second and grain-steps a CPU second.
"""
import os
import sys
import time

import numpy as np
from yade import O, utils
from yade import (Aabb, Bo1_Sphere_Aabb, ForceResetter, Ig2_Sphere_Sphere_ScGeom,  # noqa
                  InsertionSortCollider, InteractionLoop, Ip2_JCFpmMat_JCFpmMat_JCFpmPhys,
                  JCFpmMat, Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM,
                  NewtonIntegrator)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(sys.argv[0] or ".")),
                                "..", "..", "cases"))
from run_files import Run  # noqa: E402

arguments = [word for word in sys.argv[1:] if not word.startswith("-")]
run = Run(arguments[0])
n_steps = int(arguments[1]) if len(arguments) > 1 else 1000
frame = run.frame(0)
centres, radii = frame.grains.points, frame.grains.field("radius_m")
pairs = frame.joints.connectivity.reshape(-1, 2)

# Lengths over the mean diameter; a joint's k_n A of 1e3, density 1: units do not matter.
scale = 0.5 / radii.mean()
material = O.materials.append(JCFpmMat(young=1e3, poisson=0.45, density=1.,
                                       frictionAngle=0.4, tensileStrength=1e9,
                                       cohesion=1e9, type=1, label="rock"))
for (x, y), r in zip(scale * centres[:, :2], scale * radii):
    O.bodies.append(utils.sphere((x, y, 0.), r, material=material))
    O.bodies[-1].state.blockedDOFs = "zXY"
O.engines = [
    ForceResetter(),
    # The search is left as it is: no pair comes or goes, and its stride keeps it idle.
    InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=1.6)], verletDist=0.2),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=1.6)],
                    [Ip2_JCFpmMat_JCFpmMat_JCFpmPhys(cohesiveTresholdIteration=2)],
                    [Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM(recordCracks=False)]),
    NewtonIntegrator(damping=0.7),
]
O.dt = 0.
for i, j in pairs:
    utils.createInteraction(int(i), int(j))
wanted = {(min(i, j), max(i, j)) for i, j in pairs.tolist()}
O.step()
others = [i for i in O.interactions if (min(i.id1, i.id2), max(i.id1, i.id2)) not in wanted]
for interaction in others:
    O.interactions.erase(interaction.id1, interaction.id2)
real = sum(1 for i in O.interactions if i.isReal)
O.dt = 0.05 * utils.PWaveTimeStep()
for body in O.bodies:
    body.state.vel = 1e-4 * np.array([np.sin(body.state.pos[1]), np.cos(body.state.pos[0]),
                                      0.])
O.run(50, True)
begin = time.process_time()
O.run(n_steps, True)
seconds = time.process_time() - begin
print(f"{len(O.bodies)} grains, {real} interactions ({len(wanted)} joints): "
      f"{n_steps / seconds:.1f} steps/s, "
      f"{len(O.bodies) * n_steps / seconds / 1e6:.3f} M grain-steps a CPU second")
