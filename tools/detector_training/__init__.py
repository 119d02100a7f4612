"""Training of the object detector that the spherical stereo method uses. Only this part of the course needs PyTorch.

images          folders of panoramas with their boxes, held in memory
augmentation    one training sample: turned, mirrored, scaled and recoloured panorama, with its boxes
batches         the order of the samples, made beside the training
network         a Darknet cfg as a PyTorch module
assignment      which cell and anchor is responsible for which object
loss            what the network is trained to make small
state           what changes from step to step, and the checkpoint that keeps it; the learning rate
workers         several processes that train one network together
train           the loop
export          Darknet .weights, written and read
validation      precision and recall on rooms that were not trained on, and the choice of the threshold
"""
