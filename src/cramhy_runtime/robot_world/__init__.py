"""Robots, furniture and objects in three dimensions: where they are, what touches what, what falls, what a robot sees and reaches.

========================  ===========================================================================================
``descriptions``          links, joints and shapes of a robot or of furniture; ``urdf`` reads and writes them as URDF
``models``                the PR2, the kitchen and the objects that come with cramhy
``skeleton``              where the links are, given the joints (forward kinematics)
``inverse_kinematics``    the joints, given where the tool is to be
``placements``            positions and rotations, and the poses of plans
``things, world``         items and machines, and the world that they are in; worlds are copied to look ahead
``scene``                 the same for MuJoCo: contacts, falls, rays
``vision``                what a camera sees
``shown``                 which world is the current one, and who is told when it changes
``notes``                 motions one after the other, for whoever shows a world
``remarks``               what a plan considers, for whoever looks on
``pictures/``             pictures and movies of a world, without a screen
``simulated_robot``       the motions of a robot in such a world
``al5d/``                 a small arm on a table with bricks, as a ROS node
``data/``                 the PR2 and the kitchen of Bremen, as URDF of our own
========================  ===========================================================================================

The room needs the extra ``robot`` (MuJoCo), but for ``descriptions`` and ``urdf``. Importing this package imports none of its modules.
"""
