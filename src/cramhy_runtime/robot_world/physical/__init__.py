"""Worlds in which motions take time: controllers move the joints, fingers hold by friction, what slips falls.

==============  =====================================================================================
``contacts``    the shapes of things for contacts: a bowl is hollow here
``engine``      MuJoCo's model of robot, furniture and objects, and one step of it
``trajectory``  the way of joints through time, at limited speed
``world``       the world: steps in the kernel's time while something moves
``robot``       the motions of a robot in it, as those of ``simulated_robot``
``floor_ways``  ways of the base between furniture
``arm_ways``    ways of arms past furniture and objects
==============  =====================================================================================
"""
