//! Model files with effects, deviations and correlation: what is wrong with them, told where it stands.

use orthopanel_model::PanelModel;

const MODEL: &str = "{\"schema\": \"orthopanel.model/1\", \"structure\": \"timoshenko-beam\",\n\
    \"piece\": {\"length\": 0.8, \"width\": 0.1, \"thickness\": 0.03, \"mass_per_area\": 6.88},\n\
    \"constants\": {\"e_x\": {\"value\": 1.07e10, \"std\": 4e7}, \"g_zx\": 5.363e8},\n\
    \"damping\": {\"ratios\": [0.002, 0.003], \"std\": [1e-4, 2e-4]},\n\
    \"correlation\": {\"names\": [\"e_x\", \"damping_ratio_2\"], \"matrix\": [[1, 0.5], [0.5, 1]]},\n\
    \"effects\": [{\"id\": \"local-mass\", \"owner\": \"panel\", \"mass\": {\"value\": 0.02, \"std\": 0.001}, \"x\": 0.1}]}";

#[test]
fn what_was_written_reads_back() {
    let model = PanelModel::from_json(MODEL).unwrap();
    assert_eq!(model.correlation.as_ref().unwrap().of("damping_ratio_2", "e_x"), 0.5);
    assert_eq!(model.correlation.as_ref().unwrap().of("damping_ratio_1", "e_x"), 0.0);
    assert_eq!(PanelModel::from_json(&model.to_json()), Ok(model));
}

#[test]
fn faults_name_where_they_stand_and_what_is_wanted() {
    let faults = [
        (
            "\"x\": 0.1",
            "\"x\": \"left\"",
            "line 6: effects[0].x: must be a number or {\"value\": .., \"std\": ..}, not the text \"left\"",
        ),
        ("\"owner\": \"panel\", ", "", "line 6: effects[0].owner is missing"),
        ("\"local-mass\"", "7", "line 6: effects[0].id: must be a text in quotes, not 7"),
        ("[{\"id\"", "[3, {\"id\"", "line 6: effects[0]: must be an object {..}, not 3"),
        ("1e-4,", "-1e-4,", "damping.std[0] = -0.0001: must be a finite number, zero or more"),
        ("[1e-4, 2e-4]", "[1e-4, 2e-4, 1e-4]", "damping.std has 3 entries beside 2 of damping.ratios"),
        (
            "\"damping_ratio_2\"",
            "\"damping_ratio_3\"",
            "names[1] = \"damping_ratio_3\" is neither one of its constants nor damping_ratio_1 to damping_ratio_2",
        ),
        ("\"damping_ratio_2\"", "\"e_x\"", "names[1] = \"e_x\" stands twice"),
        ("[0.5, 1]]", "[0.4, 1]]", "it must be symmetric"),
        ("\"matrix\": [[1, 0.5], [0.5, 1]]", "\"matrix\": [[1, 1.5], [1.5, 1]]", "must lie between -1 and 1"),
    ];
    for (from, to, said) in faults {
        assert!(MODEL.contains(from), "{from}");
        let error = PanelModel::from_json(&MODEL.replacen(from, to, 1)).expect_err(to).to_string();
        assert!(error.contains(said), "{error}");
    }
}
