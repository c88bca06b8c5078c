// SPDX-License-Identifier: GPL-3.0-or-later
//
// A Flamenco job type: lsgp batch in shards, then a summary of the whole. Put this file into the folder "scripts" beside
// flamenco-manager. lsgp has to be installed on all workers; source and results are on storage that all of them share.

const JOB_TYPE = {
    label: "Cone Unwrap",
    description: "Unwrap all meshes of a folder or a list through cones",
    settings: [
        {
            key: "source", type: "string", subtype: "file_path", required: true,
            description: "Folder of meshes, or text file with a path on each line",
        },
        {
            key: "results", type: "string", subtype: "dir_path", required: true,
            description: "Folder of the results; what is already there is not made again",
        },
        {
            key: "shards", type: "int32", default: 16,
            description: "Number of tasks the meshes are divided into",
        },
        {
            key: "options", type: "string", required: false, default: "",
            description: "Further options of lsgp batch, quoted as on a command line",
        },
        {
            key: "program", type: "string", required: false, default: "lsgp",
            description: "How lsgp is started on the workers; a variable of the manager's, such as {lsgp}, or a path",
        },
    ],
};

function compileJob(job) {
    const settings = job.settings;
    const whole = author.Task("summary", "misc");
    for (let shard = 1; shard <= settings.shards; shard++) {
        const task = author.Task("unwrap " + shard + " of " + settings.shards, "misc");
        task.addCommand(unwrap(settings, ["--shard", shard + "/" + settings.shards]));
        job.addTask(task);
        whole.addDependency(task);
    }
    // Tries again what failed in its shard, and writes summary.txt and the contact sheet.
    whole.addCommand(unwrap(settings, []));
    job.addTask(whole);
}

// No shell is involved: every setting is an argument or part of one, whatever characters it has.
function unwrap(settings, part) {
    const further = ["--options=" + (settings.options || "")];
    const always = ["--out=" + settings.results, "--only-missing", "--exit-zero"];
    const args = ["batch"].concat(further, always, part, ["--", settings.source]);
    return author.Command("exec", { exe: settings.program || "lsgp", args: args });
}
