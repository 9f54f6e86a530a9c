(defsystem "sb-bsd-sockets"
  :description "Sockets, as the contributed module of SBCL has them."
  :components ((:file "sockets")))
