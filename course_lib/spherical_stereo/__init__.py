"""Paper 2: Onozeki, Iriyama, Ogasa, Pathak, Umeda, "Localization in a 2D semantic map using object recognition from a
spherical stereo camera". A module for each step.

    sphere               what is given: equirectangular panoramas of two cameras, one above the other
    detection            2.2: objects in a panorama, the seam, hue and saturation (with darknet, seam, colour, labels)
    stereo_matching      2.3: which object of the upper image is which of the lower one
    triangulation        2.4: from two directions to a place
    semantic_map         the map: class, place, hue and saturation of every object
    association          2.5, eq. (1): observed objects to landmarks of the map
    rigid_fit            2.6: from pairs to a pose
    localizer            figure 2: all of it in order
    evaluation           section 3: tables 1 to 5

Images are BGR uint8 arrays, as OpenCV reads them. Boxes and points on them are in edge coordinates (`sphere`).
"""
