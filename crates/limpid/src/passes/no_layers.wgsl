// Nothing is known of the sheets behind the front surface.

fn behind_of(sight: Sight) -> Behind {
    return scene_behind(sight);
}
