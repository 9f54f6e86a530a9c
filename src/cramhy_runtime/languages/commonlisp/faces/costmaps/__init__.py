"""What Lisp sees of ``robot_world.costmaps``: the functions below the library ``cram-location-costmap``."""
