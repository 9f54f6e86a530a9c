(defsystem "cl-bullet"
  :description "The names of CL-BULLET that plans use: boxes around things, copies of worlds."
  :components ((:file "cl-bullet")))
