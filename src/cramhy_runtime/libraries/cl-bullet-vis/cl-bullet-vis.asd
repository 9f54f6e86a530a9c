(defsystem "cl-bullet-vis"
  :description "The names of the window on a world. There is none here: the page shows the world."
  :depends-on ("cl-bullet")
  :components ((:file "cl-bullet-vis")))
