(defsystem "sb-rotate-byte" :description "Rotation of bytes, as the contributed module of SBCL has it." :components ((:file "rotate-byte")))
