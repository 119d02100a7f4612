"""Valid files of every format that a user hands over, damaged in many ways, each read by the reader of the commands.

formats         which formats there are: the file, the reader that the commands use, its named errors
samples         a valid file of each, with the files that belong to it
mutators        what is done to a file's bytes; by what it holds: text_, json_, mesh_, image_, number_mutators
bombs           links, pipes, devices, and small files that unpack to large ones
readings        what a reader made of a file, as plain arrays and texts that can be compared
explanations    why a changed result is right: a second reading of the file says the same (of meshes: mesh_explanation,
                depth_oracle)
trial           one file in a child process with limits of time and memory, and the verdict
campaign        many files, counted
"""
